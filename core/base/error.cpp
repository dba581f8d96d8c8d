#include "core/base/error.hpp"

namespace scree::core {

std::string Place::text() const {
  std::string out = file;
  if (line > 0) out.append(out.empty() ? "" : ":").append(std::to_string(line));
  if (line > 0 && column > 0) out.append(":").append(std::to_string(column));
  return out;
}

}  // namespace scree::core
