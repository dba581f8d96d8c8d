#include "core/run/progress.hpp"

#include <string>
#include <utility>
#include <vector>

#include "support/catch.hpp"

using namespace scree::core;

namespace {

/// A progress with a clock that the test moves and a screen that it reads.
struct Screen {
  double now = 100;
  int looks = 0;
  std::vector<std::pair<std::string, bool>> shown;
  Progress progress;

  explicit Screen(Progress::Settings settings)
      : progress(
            settings, [this](const std::string& text, bool in_place) { shown.emplace_back(text, in_place); },
            [this] {
              ++looks;
              return now;
            }) {}
};

}  // namespace

TEST_CASE("the progress line says stage, cycle, time, rates, share and time left") {
  ProgressState state;
  state.stage = "settle";
  state.cycle = 12000;
  state.model_time = 0.0125;
  CHECK(progress_text(state) == "settle  cycle 12000  t 0.0125 s");
  state.cycles_per_second = 3410;
  state.ball_steps_per_second = 9.21e6;
  state.fraction = 0.419;
  state.seconds_left = 65.4;
  CHECK(progress_text(state) == "settle  cycle 12000  t 0.0125 s  3410 cycles/s  9.21M ball-steps/s  41 %  1:05 left");
  state.seconds_left = 7322;
  state.cycles_per_second = 123456;
  state.ball_steps_per_second.reset();
  CHECK(progress_text(state) == "settle  cycle 12000  t 0.0125 s  123k cycles/s  41 %  2:02:02 left");
}

TEST_CASE("on a terminal the line is rewritten at most five times a second and taken away at the end") {
  Screen screen({.terminal = true});
  screen.progress.stage("run", 1000, 0, 100000, std::nullopt);
  for (uint64_t cycle = 1001; cycle <= 101000; ++cycle) {
    screen.now += 1e-4;  // 10 s in all
    screen.progress.tick(cycle, static_cast<double>(cycle) * 1e-5, 50);
  }
  CHECK(screen.shown.size() <= 50);
  CHECK(screen.shown.size() >= 30);
  CHECK(screen.looks < 1000);
  for (const auto& [text, in_place] : screen.shown) CHECK(in_place);
  CHECK(screen.shown.back().first.find("cycles/s") != std::string::npos);
  CHECK(screen.shown.back().first.find("ball-steps/s") != std::string::npos);
  screen.progress.finish();
  CHECK(screen.shown.back() == std::make_pair(std::string(), true));
  const size_t before = screen.shown.size();
  screen.now += 100;
  screen.progress.tick(200000, 5, 50);
  CHECK(screen.shown.size() == before);
}

TEST_CASE("elsewhere there is one plain line per 5 % of a stage") {
  Screen screen({});
  screen.progress.stage("run", 0, 1.0, std::nullopt, 0.5);
  for (uint64_t cycle = 1; cycle <= 5000; ++cycle) {
    screen.now += 1e-2;
    screen.progress.tick(cycle, 1.0 + static_cast<double>(cycle) * 1e-4, 2);
  }
  // The last cycle need not be one at which the clock is looked at, so 100 % may be left to the end of the stage.
  REQUIRE(screen.shown.size() >= 19);
  REQUIRE(screen.shown.size() <= 20);
  CHECK_FALSE(screen.shown[0].second);
  CHECK(screen.shown[0].first.find("  5 %") != std::string::npos);
  CHECK(screen.shown[9].first.find("  50 %  0:25 left") != std::string::npos);
}

TEST_CASE("without a known end lines come after 10, 20, 40 ... seconds") {
  Screen screen({});
  screen.progress.stage("solve", 0, 0, std::nullopt, std::nullopt);
  std::vector<double> at;
  for (uint64_t cycle = 1; cycle <= 100000; ++cycle) {
    screen.now += 1e-2;
    const size_t before = screen.shown.size();
    screen.progress.tick(cycle, 0, 0);
    if (screen.shown.size() > before) at.push_back(screen.now - 100);
  }
  REQUIRE(at.size() == 7);
  for (size_t k = 0; k < at.size(); ++k) CHECK(at[k] == Approx(10 << k).epsilon(0.1));
  CHECK(screen.shown[0].first.find('%') == std::string::npos);
}

TEST_CASE("quiet says nothing and never looks at the clock") {
  Screen screen({.quiet = true, .terminal = true});
  screen.progress.stage("run", 0, 0, 100, std::nullopt);
  for (uint64_t cycle = 1; cycle <= 100; ++cycle) screen.progress.tick(cycle, 0, 1);
  screen.progress.finish();
  CHECK(screen.shown.empty());
  CHECK(screen.looks == 0);
}
