#pragma once
#include <scree/abi.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/isa.hpp"
#include "core/vet/numbers.hpp"

namespace scree::core::vet {

/// Balls in the columns that a process asks for, as the kernel hands them over: up to SCREE_ROWS rows at once, words of
/// the needed columns in the order declared, null where an optional column is not kept. Guard words lie around each.
class RowBench {
 public:
  RowBench(const scree_process& table, std::size_t rows, uint64_t seed, bool optional_kept);

  double dt = 1e-5, time = 0.1;
  /// Fills every column: plain values, or extreme ones.
  void fill(uint64_t seed, bool extreme);
  void run(const void* process, Isa isa, std::size_t block);
  scree_rows prepared(std::size_t first, std::size_t count);

  std::vector<uint64_t> bits() const;
  bool finite() const;
  /// What was written that may not be; "" when nothing was.
  std::string trespass() const;

 private:
  static constexpr std::size_t guard = 8;
  struct Word {
    uint32_t column, access;
    bool kept;
    std::vector<double> values, before;
  };
  const scree_process& table_;
  std::size_t rows_;
  std::vector<Word> words_;
  std::vector<double*> pointers_;
  std::vector<double> sum_;
};

const char* column_name(uint32_t column);

}  // namespace scree::core::vet
