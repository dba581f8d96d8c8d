#include "core/base/threads.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/catch.hpp"

using namespace scree::core;

TEST_CASE("a team does every block once, in contiguous ranges by thread") {
  for (const unsigned threads : {1u, 2u, 3u, 4u, 7u}) {
    Team team(threads);
    CHECK(team.size() == threads);
    for (const size_t count : {0u, 1u, 2u, 3u, 5u, 64u, 1000u}) {
      std::vector<int> done(count);
      std::vector<unsigned> by(count);
      team.each_block(count, [&](size_t block, unsigned thread) {
        ++done[block];
        by[block] = thread;
      });
      CHECK(std::count(done.begin(), done.end(), 1) == static_cast<std::ptrdiff_t>(count));
      CHECK(std::is_sorted(by.begin(), by.end()));
      if (count > 1)
        for (unsigned t = 0; t < threads; ++t)
          CHECK(static_cast<size_t>(std::count(by.begin(), by.end(), t)) ==
                count * (t + 1) / threads - count * t / threads);
    }
  }
}

TEST_CASE("what one phase writes the next one reads on any thread") {
  // Each value is the sum of its neighbours' values of the phase before: a lost or early barrier changes it.
  const size_t n = 64;
  const auto run = [&](unsigned threads) {
    Team team(threads);
    std::vector<uint64_t> a(n, 1), b(n);
    a[0] = 5;
    for (int phase = 0; phase < 3000; ++phase) {
      team.each_block(n, [&](size_t k) { b[k] = a[(k + n - 1) % n] + 3 * a[k] + a[(k + 1) % n]; });
      a.swap(b);
    }
    return a;
  };
  const auto one = run(1);
  CHECK(run(2) == one);
  CHECK(run(3) == one);
}

TEST_CASE("sleeping threads wake up") {
  Team team(3);
  std::atomic<int> sum{0};
  for (int k = 0; k < 20; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    team.each_block(3, [&](size_t block) {
      if (block == 2) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      sum += 1;
    });
  }
  CHECK(sum == 60);
}

TEST_CASE("the exception of the lowest block comes back, and the team goes on") {
  for (const unsigned threads : {1u, 2u, 4u}) {
    Team team(threads);
    for (int k = 0; k < 50; ++k) {
      std::string text;
      try {
        team.each_block(100, [](size_t block) {
          if (block % 10 == 7) throw std::runtime_error("block " + std::to_string(block));
        });
      } catch (const std::runtime_error& error) {
        text = error.what();
      }
      CHECK(text == "block 7");
      std::atomic<int> sum{0};
      team.each_block(100, [&](size_t) { ++sum; });
      CHECK(sum == 100);
    }
  }
}

TEST_CASE("a call from inside a phase runs there alone") {
  Team team(2);
  std::atomic<int> sum{0};
  team.each_block(4, [&](size_t) { team.each_block(10, [&](size_t) { ++sum; }); });
  CHECK(sum == 40);
}

TEST_CASE("on_start runs once on each thread but the caller's") {
  std::atomic<unsigned> seen{0};
  {
    Team team(4, [&](unsigned thread) { seen += 1u << (8 * thread); });
    team.each_block(4, [](size_t) {});
  }
  CHECK(seen == 0x01010100u);
}

TEST_CASE("time of an empty phase", "[.bench]") {
  for (const unsigned threads : {1u, 2u}) {
    Team team(threads);
    const int n = 200000;
    std::vector<double> sums(64);
    const auto start = std::chrono::steady_clock::now();
    for (int k = 0; k < n; ++k) team.each_block(2, [&](size_t b) { sums[b * 32] += 1; });
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
    WARN(threads << " threads: " << time.count() / n << " ns per phase");
    CHECK(sums[0] == n);
  }
}
