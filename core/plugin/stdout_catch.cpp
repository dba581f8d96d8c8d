#include "core/plugin/stdout_catch.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace scree::core {

namespace {
constexpr std::size_t shown = 200;  // bytes: enough to know who wrote
}

StdoutCatch::StdoutCatch() {
  std::fflush(stdout);
  kept_ = ::memfd_create("stdout", MFD_CLOEXEC);
  if (kept_ < 0) return;
  real_ = ::dup(STDOUT_FILENO);
  if (real_ >= 0) ::dup2(kept_, STDOUT_FILENO);
}

StdoutCatch::~StdoutCatch() { take(); }

std::string StdoutCatch::take() {
  std::string text;
  if (real_ >= 0) {
    // What was written with printf may still wait in the library's buffer.
    std::fflush(stdout);
    ::dup2(real_, STDOUT_FILENO);
    ::close(real_);
    real_ = -1;
    text.resize(shown);
    const ssize_t n = ::pread(kept_, text.data(), text.size(), 0);
    text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
  }
  if (kept_ >= 0) ::close(kept_);
  kept_ = -1;
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c >= 0 && c < ' '; }, ' ');
  return text;
}

}  // namespace scree::core
