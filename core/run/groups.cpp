#include "core/run/groups.hpp"

#include <algorithm>

namespace scree::core {

uint16_t Groups::leaf(const std::string& name) {
  const auto at = std::find(leaves_.begin(), leaves_.end(), name);
  if (at == leaves_.end()) leaves_.push_back(name);
  return static_cast<uint16_t>(at == leaves_.end() ? leaves_.size() - 1
                                                   : static_cast<std::size_t>(at - leaves_.begin()));
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
