#include "core/vet/process_state.hpp"

#include <langinfo.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cfenv>
#include <clocale>
#include <cstring>
#include <filesystem>
#include <sstream>
#if defined(__SSE__)
#include <xmmintrin.h>
#endif

extern char** environ;

namespace scree::core::vet {

namespace {

std::size_t entries(const char* folder) {
  std::error_code error;
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) count += !entry.path().empty();
  return count;
}

std::string handler(int number) {
  struct sigaction action {};
  if (::sigaction(number, nullptr, &action) != 0) return "";
  std::ostringstream text;
  text << reinterpret_cast<const void*>(action.sa_sigaction) << ' ' << action.sa_flags;
  return text.str();
}

}  // namespace

unsigned float_mode() {
  unsigned mode = 0;
#if defined(__SSE__)
  constexpr unsigned exceptions = 0x3f;  // sticky bits say what happened, not how to compute
  mode = _mm_getcsr() & ~exceptions;
#endif
#if defined(__x86_64__)
  unsigned short control = 0;
  asm volatile("fnstcw %0" : "=m"(control));
  mode |= static_cast<unsigned>(control) << 16;
#endif
  return mode;
}

ProcessState::ProcessState() : float_mode_(float_mode()), rounding_(std::fegetround()) {
  mask_ = ::umask(0);
  ::umask(static_cast<mode_t>(mask_));
  // Asked for by what it does to numbers and text.
  locale_ = std::string(std::localeconv()->decimal_point) + std::localeconv()->thousands_sep + ::nl_langinfo(CODESET);
  std::error_code error;
  folder_ = std::filesystem::current_path(error).string();
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry)
    environment_ += std::string(*entry) + '\n';
  for (std::size_t number = 1; number < handlers_.size(); ++number)
    handlers_[number] = handler(static_cast<int>(number));
  files_ = entries("/proc/self/fd");
  threads_ = entries("/proc/self/task");
}

std::string ProcessState::difference(const ProcessState& now) const {
  if (float_mode_ != now.float_mode_ || rounding_ != now.rounding_) return "the floating-point mode";
  if (locale_ != now.locale_) return "the locale";
  if (folder_ != now.folder_) return "the working directory";
  if (environment_ != now.environment_) return "the environment";
  if (mask_ != now.mask_) return "the umask";
  for (std::size_t number = 1; number < handlers_.size(); ++number)
    if (handlers_[number] != now.handlers_[number]) return "the handler of signal " + std::to_string(number);
  if (files_ != now.files_) return "the number of open files";
  if (threads_ != now.threads_) return "the number of threads";
  return "";
}

}  // namespace scree::core::vet
