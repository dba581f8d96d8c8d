#include <cmath>
#include <limits>

#include "support/catch.hpp"
#include "support/opened.hpp"

namespace {

using support::Object;
using support::opened;

/// A block of rows: one array per word of the columns that a process needs.
struct Rows {
  std::vector<std::vector<double>> word;
  std::vector<double*> pointer;
  scree_rows table{};

  Rows(uint32_t n, std::size_t words) : word(words, std::vector<double>(n)) {
    for (auto& w : word) pointer.push_back(w.data());
    table.struct_size = sizeof table;
    table.n = n;
  }
  void run(const scree_process& process, const void* self, int isa) {
    table.word = pointer.data();
    process.rows[isa](self, &table);
  }
};

/// Deterministic numbers of both signs, with zeros among them.
double sample(std::size_t k) { return k % 11 == 0 ? 0.0 : std::sin(static_cast<double>(k * k + 1)) * 1e3; }

std::vector<int> usable_isa() {
  std::vector<int> list{0};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2"))
    list.push_back(1);
  if (list.size() == 2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    list.push_back(2);
#endif
  return list;
}

}  // namespace

TEST_CASE("gravity adds mass times acceleration", "[plugin]") {
  const auto& process = opened<scree_process>("process", "gravity");
  REQUIRE(process.need_count == 2);
  CHECK(process.needs[0].column == SCREE_MASS);
  CHECK(process.needs[0].access == SCREE_READ);
  CHECK(process.needs[1].column == SCREE_FORCE);
  CHECK(process.needs[1].access == (SCREE_READ | SCREE_WRITE));
  CHECK(process.flags == SCREE_ADDS_FORCE);
  Object gravity(process.object);
  for (const int isa : usable_isa())
    for (const uint32_t n : {0u, 1u, 7u, 256u}) {
      Rows rows(n, 4);
      for (std::size_t i = 0; i < n; ++i) {
        rows.word[0][i] = 1.0 + static_cast<double>(i);
        for (std::size_t k = 1; k < 4; ++k) rows.word[k][i] = sample(4 * i + k);
      }
      rows.run(process, gravity.self(), isa);
      for (std::size_t i = 0; i < n; ++i) {
        CHECK(rows.word[1][i] == sample(4 * i + 1));
        CHECK(rows.word[3][i] == sample(4 * i + 3) + (1.0 + static_cast<double>(i)) * -9.81);
      }
    }
  REQUIRE(gravity.vector("acceleration", {1, 2, 4}) == "");
  Rows one(1, 4);
  one.word[0][0] = 3;
  one.run(process, gravity.self(), 0);
  CHECK(one.word[1][0] == 3);
  CHECK(one.word[2][0] == 6);
  CHECK(one.word[3][0] == 12);
}

TEST_CASE("local damping takes its share against the motion, component by component", "[plugin]") {
  // F_i - alpha |F_i| sign(v_i), sign(0) = 0: Cundall 1987; Itasca, PFC manual, local damping.
  const auto& process = opened<scree_process>("process", "local_damping");
  CHECK(process.flags == (SCREE_SCALES_FORCE | SCREE_LOCAL_DAMPING));
  REQUIRE(process.need_count == 4);
  CHECK(process.needs[2].access == (SCREE_READ | SCREE_OPTIONAL));
  CHECK(process.needs[3].access == (SCREE_READ | SCREE_WRITE | SCREE_OPTIONAL));
  Object damping(process.object);
  CHECK(process.damping(damping.self()) == 0.7);
  CHECK(damping.number("factor", 1) == "'factor' is 1, but must be below 1");
  CHECK(damping.number("factor", -0.1) == "'factor' is -0.1, but must be at least 0");
  REQUIRE(damping.number("factor", 0.25) == "");
  const uint32_t n = 203;
  const auto sign = [](double v) { return v > 0 ? 1.0 : (v < 0 ? -1.0 : 0.0); };
  for (const bool spin : {true, false})
    for (const int isa : usable_isa()) {
      Rows rows(n, 12);
      for (std::size_t k = 0; k < 12; ++k)
        for (std::size_t i = 0; i < n; ++i) rows.word[k][i] = sample(12 * i + k);
      if (!spin)
        for (std::size_t k = 6; k < 12; ++k) rows.pointer[k] = nullptr;
      rows.run(process, damping.self(), isa);
      for (std::size_t k = 0; k < 12; ++k)
        for (std::size_t i = 0; i < n; ++i) {
          const double before = sample(12 * i + k), v = sample(12 * i + k - 3);
          const bool written = (k >= 3 && k < 6) || (spin && k >= 9);
          const double expected = written ? before - 0.25 * (std::abs(before) * sign(v)) : before;
          REQUIRE(rows.word[k][i] == expected);
        }
    }
}

TEST_CASE("local damping keeps a NaN force, so that the guards see it", "[plugin]") {
  const auto& process = opened<scree_process>("process", "local_damping");
  Object damping(process.object);
  for (const int isa : usable_isa()) {
    Rows rows(9, 12);
    rows.word[1][4] = 1;
    rows.word[4][4] = std::numeric_limits<double>::quiet_NaN();
    rows.run(process, damping.self(), isa);
    CHECK(std::isnan(rows.word[4][4]));
    CHECK(rows.word[3][4] == 0);
    CHECK(rows.word[4][5] == 0);
  }
}
