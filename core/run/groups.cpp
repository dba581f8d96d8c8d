#include "core/run/groups.hpp"

#include <algorithm>

namespace scree::core {

uint16_t Groups::leaf(const std::string& name) {
  const auto index = static_cast<std::size_t>(std::find(leaves_.begin(), leaves_.end(), name) - leaves_.begin());
  if (index == leaves_.size()) leaves_.push_back(name);
  return static_cast<uint16_t>(index);
}

std::vector<uint8_t> Groups::cover(const std::string& name) const {
  std::vector<uint8_t> covered(leaves_.size());
  for (std::size_t k = 0; k < leaves_.size(); ++k)
    covered[k] = name == "balls" || leaves_[k] == name || leaves_[k].starts_with(name + ".");
  return covered;
}

bool Groups::knows(const std::string& name) const {
  const auto covered = cover(name);
  return std::find(covered.begin(), covered.end(), uint8_t{1}) != covered.end();
}

}  // namespace scree::core
