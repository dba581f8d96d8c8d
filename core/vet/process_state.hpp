#pragma once
#include <array>
#include <string>

namespace scree::core::vet {

/// What the code of a plug-in must leave as it finds it, as far as one can ask the system.
class ProcessState {
 public:
  ProcessState();
  /// The first thing that is not as it was: "the floating-point mode", "the handler of SIGFPE", ...; "" when all is.
  std::string difference(const ProcessState& now) const;

 private:
  unsigned float_mode_ = 0, float_mode_x87_ = 0, mask_ = 0;
  int rounding_ = 0;
  std::string locale_, folder_, environment_;
  std::array<std::string, 32> handlers_;
  std::size_t files_ = 0, threads_ = 0;
};

/// The floating-point control words alone: cheap enough to ask around every call.
unsigned float_mode();

}  // namespace scree::core::vet
