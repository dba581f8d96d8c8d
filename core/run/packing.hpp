#pragma once
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/run/archive.hpp"

namespace scree::core {

/// Small mixed values one after the other, for one section. [one thread]
class Packer {
 public:
  void u64(uint64_t value) { raw(&value, sizeof value); }
  void f64(double value) { u64(std::bit_cast<uint64_t>(value)); }
  void flag(bool value) { u64(value ? 1 : 0); }
  void text(std::string_view value) {
    u64(value.size());
    raw(value.data(), value.size());
  }
  void f64s(const double* values, std::size_t n) {
    for (std::size_t k = 0; k < n; ++k) f64(values[k]);
  }
  const std::vector<uint8_t>& bytes() const { return bytes_; }

 private:
  void raw(const void* from, std::size_t size);
  std::vector<uint8_t> bytes_;
};

/// Reads what a Packer wrote. Anything that does not fit is refused with the name of the section. [one thread]
class Unpacker {
 public:
  Unpacker(const ArchiveReader& in, std::string section);

  uint64_t u64();
  double f64() { return std::bit_cast<double>(u64()); }
  bool flag();
  std::string text();
  /// A number of items that follow, each at least `least` bytes long.
  uint64_t count(uint64_t least = 8);
  void f64s(double* values, std::size_t n) {
    for (std::size_t k = 0; k < n; ++k) values[k] = f64();
  }
  /// Refuses when something is left.
  void finish();
  [[noreturn]] void refuse(const std::string& why) const;

 private:
  const ArchiveReader& in_;
  std::string section_;
  std::vector<uint8_t> bytes_;
  std::size_t at_ = 0;
};

}  // namespace scree::core
