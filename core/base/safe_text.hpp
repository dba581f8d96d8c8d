#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/crash_note.hpp"

namespace scree::core {

/// Text that a signal handler may put together: no allocation, no locale, no locks. Cut at 2 KiB.
class SafeText {
 public:
  SafeText& operator<<(const char* text) {
    while (*text != '\0' && size_ < sizeof text_) text_[size_++] = *text++;
    return *this;
  }
  SafeText& operator<<(uint64_t number) {
    char digits[21];
    int k = 20;
    digits[k] = '\0';
    do digits[--k] = static_cast<char>('0' + number % 10);
    while ((number /= 10) != 0);
    return *this << digits + k;
  }
  /// Where a thread is: plug-in, what it is used as, cycle, block, first contact of the batch.
  SafeText& operator<<(const CrashNote& note) {
    *this << "plug-in '" << note.plugin << "'";
    if (note.rule != nullptr) *this << ", used as '" << note.rule << "'";
    *this << ", cycle " << note.cycle << ", block " << note.block;
    if (note.id1 != 0 && note.wall != nullptr)
      *this << ", first contact of the batch: ball " << note.id1 << " and wall '" << note.wall << "'";
    else if (note.id1 != 0)
      *this << ", first contact of the batch: balls " << note.id1 << " and " << note.id2;
    return *this;
  }
  std::string_view view() const { return {text_, size_}; }

 private:
  char text_[2048];
  std::size_t size_ = 0;
};

}  // namespace scree::core
