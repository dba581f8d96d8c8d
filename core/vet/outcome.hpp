#pragma once
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace scree::core::vet {

/// How a check ended. Only `fail` makes a library fail; a note is something the author should know and may want.
enum class Verdict { pass, note, info, skip, fail };
const char* verdict_name(Verdict verdict);

/// What a check found.
struct Outcome {
  Verdict verdict = Verdict::pass;
  std::string found;  ///< what was seen: on failure the worst case with its inputs; why it was skipped
  std::string next;   ///< on failure: what to change
  double figure = std::numeric_limits<double>::quiet_NaN();     ///< the worst figure; NaN: none was measured
  double tolerance = std::numeric_limits<double>::quiet_NaN();  ///< what it may be at most

  /// As bytes for a pipe, and back. Throws std::runtime_error on bytes that are no outcome.
  std::string packed() const;
  static Outcome unpacked(const std::string& bytes);
};

inline Outcome passed(const std::string& found = "") { return {Verdict::pass, found, "", NAN, NAN}; }
inline Outcome failed(const std::string& found, const std::string& next) {
  return {Verdict::fail, found, next, NAN, NAN};
}

/// Thrown by a check that has nothing to check, with the reason.
struct Skipped : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// Thrown by a check that cannot go on because of what the plug-in did.
struct Failed : std::runtime_error {
  Failed(const std::string& found, std::string what_next) : std::runtime_error(found), next(std::move(what_next)) {}
  std::string next;
};

/// The largest figure of many and the case it belongs to. What is not a number counts as larger than anything.
class Worst {
 public:
  /// `describe` is called only for a new worst case.
  template <class Describe>
  void see(double figure, Describe describe) {
    const double size = std::isnan(figure) ? std::numeric_limits<double>::infinity() : figure;
    if (seen_ > 0 && !(size > figure_)) return;
    figure_ = size;
    where_ = describe();
    ++seen_;
  }
  double figure() const { return figure_; }
  const std::string& where() const { return where_; }
  /// Pass up to `tolerance`, else fail with the worst case. Throws Skipped when nothing was seen.
  Outcome judged(double tolerance, const std::string& next) const;

 private:
  double figure_ = 0;
  std::string where_;
  unsigned seen_ = 0;
};

}  // namespace scree::core::vet
