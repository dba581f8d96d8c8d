#include <cstring>

#include "core/vet/kind_checks.hpp"
#include "core/vet/purity.hpp"
#include "core/vet/wall_bench.hpp"

namespace scree::core::vet {

namespace {

constexpr double reach = 0.06;  // m
constexpr std::size_t capacity = 4096, walls = 12;

const scree_wall& table_of(const Subject& subject) { return subject.component->wall(); }
const void* code_of(const Subject& subject) { return reinterpret_cast<const void*>(table_of(subject).touch); }

bool same(const Touch& a, const Touch& b) {
  return a.patch == b.patch && std::memcmp(&a.normal, &b.normal, sizeof a.normal) == 0 &&
         std::memcmp(&a.distance, &b.distance, sizeof a.distance) == 0;
}

template <class Run>
void each_call(const Subject& subject, uint64_t seed, const Run& run) {
  WallBench bench(table_of(subject), capacity);
  for_walls(subject, walls, [&](const void* wall, const Settings& settings) {
    for (const double away : {0.5 * reach, reach}) {
      bench.prepare(wall, points(200, seed), away, capacity);
      run(bench, [&] { return text_of(table_of(subject).object, settings); });
    }
  });
}

}  // namespace

Outcome wall_arrays(const Subject& subject) {
  Worst worst;
  WallBench all(table_of(subject), capacity), single(table_of(subject), capacity);
  for_walls(subject, walls, [&](const void* wall, const Settings& settings) {
    const std::vector<Vec3> centres = points(300, 11);
    all.ask(wall, centres, reach, capacity);
    const std::vector<Touch> list = all.touches();
    for (uint32_t i = 0; i < centres.size(); ++i) {
      single.ask(wall, {centres[i]}, reach, capacity);
      std::vector<Touch> mine;
      for (const Touch& t : list)
        if (t.ball == i) mine.push_back(t);
      const std::vector<Touch> alone = single.touches();
      bool equal = mine.size() == alone.size();
      for (std::size_t k = 0; equal && k < mine.size(); ++k) equal = same(mine[k], alone[k]);
      worst.see(equal ? 0 : 1, [&] {
        return fmt::format("the ball at {} has {} touches alone and {} among others, or others; {}",
                           text_of(centres[i]), alone.size(), mine.size(), text_of(table_of(subject).object, settings));
      });
    }
  });
  return worst.judged(0, "the touches of a ball must not depend on the balls that are asked for with it");
}

Outcome wall_overflow(const Subject& subject) {
  Worst worst;
  WallBench bench(table_of(subject), capacity);
  for_walls(subject, walls, [&](const void* wall, const Settings& settings) {
    const std::vector<Vec3> centres = points(300, 12);
    const uint32_t all = bench.ask(wall, centres, reach, capacity);
    const std::vector<Touch> first = bench.touches();
    for (const std::size_t room : {0u, 1u, 2u, 7u}) {
      const uint32_t count = bench.ask(wall, centres, reach, room);
      const std::vector<Touch> some = bench.touches();
      bool good = count == all && !bench.trespassed();
      for (std::size_t k = 0; good && k < some.size(); ++k) good = same(some[k], first[k]);
      worst.see(good ? 0 : 1, [&] {
        return fmt::format("with room for {} touches it counts {} of {}{}; {}", room, count, all,
                           bench.trespassed() ? " and writes beyond the room" : "",
                           text_of(table_of(subject).object, settings));
      });
    }
  });
  return worst.judged(0, "count every touch, write only as many as there is room for: the program asks again");
}

Outcome wall_extremes(const Subject& subject) {
  WallBench bench(table_of(subject), capacity);
  std::size_t seen = 0;
  for_walls(subject, walls, [&](const void* wall, const Settings& settings) {
    std::vector<Vec3> far;
    Numbers random(13);
    for (const double size : {0.0, 5e-324, 1e-300, 1e-12, 1.0, 1e6, 1e100}) {
      for (int k = 0; k < 8; ++k) far.push_back(size * random.direction());
      far.push_back({size, 0, 0});
      far.push_back({0, 0, -size});
    }
    for (const double away : {1e-12, 0.06, 1e9}) {
      bench.ask(wall, far, away, capacity);
      for (const Touch& t : bench.touches()) {
        ++seen;
        if (!std::isfinite(t.distance) || !std::isfinite(t.normal.squaredNorm()) || t.ball >= far.size())
          throw Failed(fmt::format("a ball at {} touches with normal {} at {} m; {}", text_of(far[t.ball % far.size()]),
                                   text_of(t.normal), t.distance, text_of(table_of(subject).object, settings)),
                       "look for a division by a distance of zero");
      }
    }
    const double nan = std::numeric_limits<double>::quiet_NaN();
    bench.ask(wall, {{nan, 0, 0}, {nan, nan, nan}}, 0.06, capacity);
  });
  return passed(fmt::format("{} touches", seen));
}

Outcome wall_allocates(const Subject& subject) {
  return nothing_allocated(code_of(subject), [&](const auto& run) { each_call(subject, 14, run); });
}
Outcome wall_global_state(const Subject& subject) {
  return nothing_kept(code_of(subject), [&](const auto& run) { each_call(subject, 15, run); });
}
Outcome wall_float_mode(const Subject& subject) {
  return mode_kept([&](const auto& run) { each_call(subject, 16, run); });
}

}  // namespace scree::core::vet
