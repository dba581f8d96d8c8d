#include "core/vet/row_bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace scree::core::vet {

namespace {

constexpr double mark = -6.27e66;
constexpr std::array names = {"position", "velocity", "spin", "force", "moment", "radius", "mass", "inertia", "fixed"};

uint32_t words_of(uint32_t column) { return column <= SCREE_MOMENT ? 3 : 1; }

double plain_value(uint32_t column, Numbers& random) {
  switch (column) {
    case SCREE_POSITION:
      return random.between(-0.2, 0.2);
    case SCREE_VELOCITY:
    case SCREE_FORCE:
      return random.between(-2, 2);
    case SCREE_SPIN:
      return random.between(-20, 20);
    case SCREE_MOMENT:
      return random.between(-0.1, 0.1);
    case SCREE_FIXED:
      return 0;
    default:
      return random.spread(1e-3, 1e-1);
  }
}

double extreme_value(uint32_t column, Numbers& random) {
  if (column == SCREE_FIXED) return 0;
  if (column >= SCREE_RADIUS) return random.chance(0.5) ? 1e-12 : 1e6;
  constexpr double sizes[] = {0.0, -0.0, 5e-324, 1e-200, 1e6, 1e12};
  return (random.chance(0.5) ? 1 : -1) * sizes[random.below(6)];
}

}  // namespace

const char* column_name(uint32_t column) { return column < names.size() ? names[column] : "unknown"; }

RowBench::RowBench(const scree_process& table, std::size_t rows, uint64_t seed, bool optional_kept)
    : table_(table), rows_(rows) {
  for (uint32_t k = 0; k < table.need_count; ++k)
    for (uint32_t w = 0; w < words_of(table.needs[k].column); ++w)
      words_.push_back({table.needs[k].column,
                        table.needs[k].access,
                        optional_kept || (table.needs[k].access & SCREE_OPTIONAL) == 0,
                        std::vector<double>(rows + 2 * guard, mark),
                        {}});
  sum_.assign(table.sums + 1, 0.0);
  fill(seed, false);
}

void RowBench::fill(uint64_t seed, bool extreme) {
  // The words of a column that is asked for twice hold the same values, as in the kernel.
  for (std::size_t k = 0; k < words_.size(); ++k) {
    Word& word = words_[k];
    std::size_t component = 0;
    for (std::size_t j = k; j-- > 0 && words_[j].column == word.column;) ++component;
    component %= words_of(word.column);
    Numbers random(seed * 1000 + word.column * 10 + component);
    for (std::size_t i = 0; i < rows_; ++i)
      word.values[guard + i] = extreme ? extreme_value(word.column, random) : plain_value(word.column, random);
    word.before = word.values;
  }
}

scree_rows RowBench::prepared(std::size_t first, std::size_t count) {
  pointers_.clear();
  for (Word& word : words_) pointers_.push_back(word.kept ? word.values.data() + guard + first : nullptr);
  std::fill(sum_.begin(), sum_.end(), 0.0);
  return {sizeof(scree_rows), static_cast<uint32_t>(count), first, 7, time, dt, pointers_.data(), sum_.data()};
}

void RowBench::run(const void* process, Isa isa, std::size_t block) {
  const auto rows = pick(table_.rows, isa);
  for (std::size_t first = 0; first < rows_; first += block) {
    const scree_rows b = prepared(first, std::min(block, rows_ - first));
    rows(process, &b);
  }
}

std::vector<uint64_t> RowBench::bits() const {
  std::vector<uint64_t> all;
  for (const Word& word : words_)
    for (std::size_t i = 0; i < rows_; ++i) {
      uint64_t bits;
      std::memcpy(&bits, &word.values[guard + i], sizeof bits);
      all.push_back(bits);
    }
  return all;
}

bool RowBench::finite() const {
  return std::all_of(words_.begin(), words_.end(), [](const Word& word) {
    return std::all_of(word.values.begin(), word.values.end(), [](double v) { return std::isfinite(v); });
  });
}

std::string RowBench::trespass() const {
  for (const Word& word : words_) {
    const auto same = [&](std::size_t i) { return std::memcmp(&word.values[i], &word.before[i], sizeof(double)) == 0; };
    for (std::size_t i = 0; i < guard; ++i)
      if (!same(i) || !same(guard + rows_ + i))
        return std::string("words beside the column ") + column_name(word.column);
    for (std::size_t i = 0; i < word.values.size(); ++i)
      if ((word.access & SCREE_WRITE) == 0 && !same(i))
        return std::string("the column ") + column_name(word.column) + ", which it only asked to read";
  }
  return "";
}

}  // namespace scree::core::vet
