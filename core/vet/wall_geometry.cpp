#include <cmath>
#include <map>
#include <set>

#include "core/vet/kind_checks.hpp"
#include "core/vet/wall_bench.hpp"

namespace scree::core::vet {

namespace {

constexpr double reach = 0.06;  // m
constexpr std::size_t capacity = 1024, walls = 16;

const scree_wall& table_of(const Subject& subject) { return subject.component->wall(); }

/// Calls f(point, touches, settings) for single balls.
template <class F>
void for_balls(const Subject& subject, uint64_t seed, F f) {
  WallBench bench(table_of(subject), capacity);
  for_walls(subject, walls, [&](const void* wall, const Settings& settings) {
    for (const Vec3& x : points(400, seed)) {
      bench.ask(wall, {x}, reach, capacity);
      f(x, bench, wall, settings);
    }
  });
}

}  // namespace

Outcome wall_touches_sound(const Subject& subject) {
  Worst worst;
  std::size_t seen = 0;
  for_balls(subject, 1, [&](const Vec3& x, const WallBench& bench, const void*, const Settings& settings) {
    std::set<uint32_t> patches;
    for (const Touch& t : bench.touches()) {
      ++seen;
      const double off = std::abs(t.normal.norm() - 1);
      const bool twice = !patches.insert(t.patch).second;
      worst.see(std::isfinite(t.distance) && t.ball == 0 && !twice ? off : NAN, [&] {
        return fmt::format("a ball at {} touches patch {}{} with normal {} at distance {:.6g} m; {}", text_of(x),
                           t.patch, twice ? " twice" : "", text_of(t.normal), t.distance,
                           text_of(table_of(subject).object, settings));
      });
    }
  });
  Outcome outcome = worst.judged(1e-14,
                                 "give a unit normal, a finite distance, the index of the ball, and each patch of a "
                                 "ball once: contact state belongs to ball and patch");
  if (outcome.verdict == Verdict::pass) outcome.found = fmt::format("{} touches", seen);
  return outcome;
}

Outcome wall_slope(const Subject& subject) {
  WallBench moved(table_of(subject), capacity);
  Worst worst;
  Numbers random(2);
  for_balls(subject, 3, [&](const Vec3& x, const WallBench& bench, const void* wall, const Settings& settings) {
    constexpr double h = 1e-6;
    const Vec3 way = random.direction();
    std::map<uint32_t, double> change;
    for (const Touch& here : bench.touches()) {
      double distance[2];
      bool both = true;
      for (const int side : {0, 1}) {
        moved.ask(wall, {x + (side == 0 ? h : -h) * way}, reach, capacity);
        bool found = false;
        for (const Touch& t : moved.touches())
          if (t.patch == here.patch) distance[side] = t.distance, found = true;
        both = both && found;
      }
      // Near an edge a touch comes or goes; near the centre of a curved patch the slope turns within the step.
      if (!both || std::abs(here.distance) < 1e-3) continue;
      const double slope = (distance[0] - distance[1]) / (2 * h), expected = -here.normal.dot(way);
      worst.see(std::abs(slope - expected), [&] {
        return fmt::format(
            "at {} patch {} has normal {}, but along {} its distance changes by {:.6g} a metre instead of "
            "{:.6g}; {}",
            text_of(x), here.patch, text_of(here.normal), text_of(way), slope, expected,
            text_of(table_of(subject).object, settings));
      });
    }
  });
  return worst.judged(1e-4,
                      "'distance' is measured along 'normal', from the centre to the surface: its slope is minus the "
                      "normal, or contacts with this wall make energy");
}

Outcome wall_reach(const Subject& subject) {
  WallBench near(table_of(subject), capacity);
  Worst worst;
  for_balls(subject, 4, [&](const Vec3& x, const WallBench& far, const void* wall, const Settings& settings) {
    const auto say = [&](const std::string& what) {
      return fmt::format("a ball at {}: {}; {}", text_of(x), what, text_of(table_of(subject).object, settings));
    };
    const double less = 0.3 * reach;
    near.ask(wall, {x}, less, capacity);
    std::map<uint32_t, Touch> wide;
    for (const Touch& t : far.touches()) {
      wide[t.patch] = t;
      worst.see(t.distance < reach ? 0 : 1, [&] {
        return say(fmt::format("patch {} is {:.6g} m away, asked for {:.6g} m", t.patch, t.distance, reach));
      });
    }
    std::size_t within = 0;
    for (const auto& [patch, t] : wide) within += std::abs(t.distance) < less;
    worst.see(within <= near.touches().size() ? 0 : 1, [&] {
      return say(fmt::format("{} patches lie nearer than {:.6g} m, but asked for that reach it names {}", within, less,
                             near.touches().size()));
    });
    for (const Touch& t : near.touches()) {
      const auto same = wide.find(t.patch);
      worst.see(same != wide.end() && same->second.distance == t.distance ? 0 : 1, [&] {
        return say(fmt::format("patch {} has another distance for a smaller reach, or is not there for a larger one",
                               t.patch));
      });
    }
  });
  return worst.judged(0, "name every piece of the surface that lies nearer than 'reach', whatever the reach is");
}

Outcome wall_flat(const Subject& subject) {
  if ((table_of(subject).flags & SCREE_WALL_FLAT) == 0) throw Skipped("it does not claim to be flat");
  Worst worst;
  const Settings* last = nullptr;
  std::map<uint32_t, Vec3> normals;
  for_balls(subject, 5, [&](const Vec3& x, const WallBench& bench, const void*, const Settings& settings) {
    if (&settings != last) normals.clear();
    last = &settings;
    for (const Touch& t : bench.touches()) {
      const Vec3 first = normals.emplace(t.patch, t.normal).first->second;
      worst.see((t.normal - first).norm(), [&] {
        return fmt::format("patch {} has normal {} at {} and {} elsewhere; {}", t.patch, text_of(t.normal), text_of(x),
                           text_of(first), text_of(table_of(subject).object, settings));
      });
    }
  });
  return worst.judged(1e-14, "leave 'flat' out where a patch is curved");
}

namespace {
/// Polygons of a wall, and the first one that is wrong.
struct Picture {
  std::size_t polygons = 0;
  std::string flaw;
  static void take(void* self, uint32_t corners, const double* xyz) {
    Picture& picture = *static_cast<Picture*>(self);
    ++picture.polygons;
    if (corners < 3) picture.flaw = fmt::format("polygon {} has {} corners", picture.polygons, corners);
    for (uint32_t k = 0; k < 3 * corners; ++k)
      if (!std::isfinite(xyz[k]))
        picture.flaw = fmt::format("corner {} of polygon {} is not finite", k / 3, picture.polygons);
  }
};
}  // namespace

Outcome wall_outline(const Subject& subject) {
  const scree_wall& table = table_of(subject);
  if (table.outline == nullptr && table.area == nullptr) throw Skipped("it has neither outline nor area");
  const double low[3] = {-0.2, -0.2, -0.2}, high[3] = {0.2, 0.2, 0.2};
  Picture picture;
  for_walls(subject, walls, [&](const void* wall, const Settings& settings) {
    const auto say = [&](const std::string& what) { return what + "; " + text_of(table.object, settings); };
    if (table.outline != nullptr) table.outline(wall, low, high, &picture, &Picture::take);
    if (!picture.flaw.empty()) throw Failed(say(picture.flaw), "give each face at least three corners, cut to the box");
    const double area = table.area != nullptr ? table.area(wall) : 0;
    if (!(area >= 0) || !std::isfinite(area))
      throw Failed(say(fmt::format("its area is {} m2", area)),
                   "give the area in m2; leave 'area' out when it is unbounded");
  });
  return passed(fmt::format("{} polygons", picture.polygons));
}

}  // namespace scree::core::vet
