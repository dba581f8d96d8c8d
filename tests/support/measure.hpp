#pragma once
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "support/catch.hpp"

namespace support {

/// Shortest decimal text that reads back as the same double.
inline std::string digits(double value) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// One verification case: every measured value is checked against its closed form and leaves a line on stdout that
/// tests/verify/verification.sh turns into a row of docs/verification.md.
class Measure {
 public:
  /// `source`: the closed form and where it comes from.
  Measure(std::string id, std::string source) : id_(std::move(id)), source_(std::move(source)) {}

  void check(const std::string& quantity, double value, double reference, double tolerance) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begun_;
    std::printf("MEASURE\t%s\t%s\t%s\t%s\t%s\t%.3f\t%s\n", id_.c_str(), quantity.c_str(), digits(value).c_str(),
                digits(reference).c_str(), digits(tolerance).c_str(), spent.count(), source_.c_str());
    std::fflush(stdout);
    INFO(id_ << ", " << quantity << ": " << value << " instead of " << reference << " within " << tolerance);
    CHECK(std::abs(value - reference) <= tolerance);
    begun_ = std::chrono::steady_clock::now();
  }

 private:
  std::string id_, source_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

}  // namespace support
