#include <cmath>
#include <cstring>
#include <set>

#include "core/base/log.hpp"
#include "core/vet/kind_checks.hpp"
#include "core/vet/object.hpp"

namespace scree::core::vet {

namespace {

struct Placed {
  scree_ball ball;
  std::string group;
};

/// Where a generator puts its balls: any place within the room is free that no earlier ball overlaps.
class Host {
 public:
  Host(std::size_t room, bool cell) : room_(room) {
    random_ = {sizeof(scree_random), 0, this, &uniform, &normal};
    table_ = {sizeof(scree_sink), 0, this, &place, &try_place, &random_, nullptr, nullptr, nullptr, &warn};
    if (cell) table_.cell_low = low_, table_.cell_high = high_, table_.periodic = periodic_;
  }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
  const scree_sink* table() const { return &table_; }

  std::vector<Placed> balls;
  bool refused = false, went_on = false;

 private:
  static int place(void* self, const scree_ball* ball) {
    Host& host = *static_cast<Host*>(self);
    host.went_on = host.went_on || host.refused;
    host.refused = host.balls.size() >= host.room_;
    if (host.refused) return 0;
    host.balls.push_back({*ball, (ball->given & SCREE_BALL_GROUP) != 0 && ball->group != nullptr ? ball->group : ""});
    return 1;
  }
  static int try_place(void* self, const scree_ball* ball) {
    Host& host = *static_cast<Host*>(self);
    if (host.balls.size() >= host.room_) return 0;
    for (const Placed& other : host.balls) {
      double square = 0;
      for (int k = 0; k < 3; ++k)
        square += (ball->position[k] - other.ball.position[k]) * (ball->position[k] - other.ball.position[k]);
      const double reach = ball->radius + other.ball.radius;
      if (square < reach * reach) return 0;
    }
    return place(self, ball);
  }
  static double uniform(void*, uint64_t index, uint64_t draw) {
    return Numbers(index * 0x9e3779b97f4a7c15u + draw).between(0, 1);
  }
  static double normal(void* self, uint64_t index, uint64_t draw) {
    const double u = uniform(self, index, 2 * draw + 1000000), v = uniform(self, index, 2 * draw + 1000001);
    return std::sqrt(-2 * std::log(1 - u)) * std::cos(6.283185307179586 * v);
  }
  static void warn(void*, const char*) {}

  std::size_t room_;
  const double low_[3] = {-0.2, -0.2, -0.2}, high_[3] = {0.2, 0.2, 0.2};
  const uint8_t periodic_[3] = {1, 1, 0};
  scree_random random_{};
  scree_sink table_{};
};

const scree_generator& table_of(const Subject& subject) { return subject.component->generator(); }

/// Generates once; the reason when it refuses, which it must give unless the host refused a ball.
std::string generated(const Subject& subject, const Settings& settings, Host& host) {
  const scree_generator& table = table_of(subject);
  Object object(table.object);
  object.set_all(settings);
  Refused refused;
  if (table.generate(object.get(), host.table(), &refused.table) == 0) return "";
  if (refused.why[0] == 0 && !host.refused)
    throw Failed("it refuses without a reason; " + text_of(table.object, settings),
                 "throw a std::exception that says why");
  return refused.why[0] != 0 ? refused.why : "stopped";
}

/// Calls f(settings) for settings with which it generates; throws Skipped when there are none.
template <class F>
void for_generators(const Subject& subject, F f) {
  std::string why;
  std::size_t good = 0;
  for (const Settings& settings : accepted_settings(subject, 24)) {
    Host host(400, false);
    why = generated(subject, settings, host);
    if (host.balls.empty()) continue;
    ++good;
    f(settings);
  }
  if (good == 0) throw Skipped("no balls came with any settings that were tried: " + why);
}

bool same(const std::vector<Placed>& a, const std::vector<Placed>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (std::memcmp(a[k].ball.position, b[k].ball.position, sizeof a[k].ball.position) != 0 ||
        a[k].ball.radius != b[k].ball.radius || a[k].group != b[k].group || a[k].ball.given != b[k].ball.given)
      return false;
  return true;
}

}  // namespace

Outcome generator_repeatable(const Subject& subject) {
  Worst worst;
  for_generators(subject, [&](const Settings& settings) {
    Host first(400, false), second(400, false), other(400, true);
    generated(subject, settings, first);
    generated(subject, settings, other);
    generated(subject, settings, second);
    worst.see(same(first.balls, second.balls) ? 0 : 1, [&] {
      return fmt::format("{} balls, then {} or others, from the same random numbers; {}", first.balls.size(),
                         second.balls.size(), text_of(table_of(subject).object, settings));
    });
  });
  return worst.judged(0, "all randomness comes from the sink, keyed by ball and draw; keep nothing between calls");
}

Outcome generator_balls_sound(const Subject& subject) {
  std::size_t seen = 0;
  for_generators(subject, [&](const Settings& settings) {
    for (const bool cell : {false, true}) {
      Host host(400, cell);
      generated(subject, settings, host);
      std::set<uint64_t> ids;
      for (const Placed& placed : host.balls) {
        const scree_ball& b = placed.ball;
        ++seen;
        bool good = b.radius > 0 && std::isfinite(b.radius);
        for (const double x : b.position) good = good && std::isfinite(x);
        if ((b.given & SCREE_BALL_DENSITY) != 0) good = good && b.density > 0 && std::isfinite(b.density);
        for (int k = 0; k < 3; ++k) {
          good = good && ((b.given & SCREE_BALL_VELOCITY) == 0 || std::isfinite(b.velocity[k]));
          good = good && ((b.given & SCREE_BALL_SPIN) == 0 || std::isfinite(b.spin[k]));
        }
        if ((b.given & SCREE_BALL_ID) != 0) good = good && b.id > 0 && ids.insert(b.id).second;
        if (!good)
          throw Failed(
              fmt::format("ball {} has radius {} at ({}, {}, {}), id {}; {}", seen, b.radius, b.position[0],
                          b.position[1], b.position[2], b.id, text_of(table_of(subject).object, settings)),
              "give positive finite radii and densities, finite positions, ids that are unique and at least 1");
      }
    }
  });
  return passed(fmt::format("{} balls", seen));
}

Outcome generator_stops(const Subject& subject) {
  Worst worst;
  for_generators(subject, [&](const Settings& settings) {
    for (const std::size_t room : {0u, 1u}) {
      Host host(room, false);
      const std::string why = generated(subject, settings, host);
      const bool good = !host.refused || (!host.went_on && !why.empty());
      worst.see(good ? 0 : 1, [&] {
        return fmt::format("the program refused ball {}, and it {}; {}", room + 1,
                           host.went_on ? "went on" : "said that all went well",
                           text_of(table_of(subject).object, settings));
      });
    }
  });
  return worst.judged(0, "when the sink refuses a ball, stop and let its exception pass");
}

}  // namespace scree::core::vet
