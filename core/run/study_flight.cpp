#include "core/run/study_flight.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>

#include "core/contact/diagonal_rule.hpp"
#include "core/run/explain.hpp"
#include "core/run/signals.hpp"
#include "core/run/study_statistics.hpp"

namespace scree::core {

namespace {

std::vector<std::size_t> by_id(const Balls& balls) {
  std::vector<std::size_t> rows(balls.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) { return balls.id()[a] < balls.id()[b]; });
  return rows;
}

std::vector<double> in_order(const Balls& balls, std::initializer_list<Column> columns) {
  std::vector<double> out;
  for (const std::size_t row : by_id(balls))
    for (const Column c : columns) out.push_back(balls[c][row]);
  return out;
}

std::vector<double> positions(const Engine& engine) {
  return in_order(engine.balls, {Column::x, Column::y, Column::z});
}

// A shift in a direction of its own for each ball, the same in every study.
void shift(Balls& balls) {
  for (std::size_t row = 0; row < balls.size(); ++row) {
    if (balls.fixed() != nullptr && (balls.fixed()[row] & (fix_x | fix_y | fix_z)) != 0) continue;
    const double phase = 2.399963229728653 * static_cast<double>(balls.id()[row] % 100003);  // golden angle
    const double size = 1e-10 * balls[Column::radius][row];
    balls[Column::x][row] += size * std::cos(phase);
    balls[Column::y][row] += size * std::sin(phase);
    balls[Column::z][row] += size * std::cos(1.7 * phase);
  }
}

double largest_distance(const Engine& a, const Engine& b) {
  const std::vector<double> one = positions(a), other = positions(b);
  double most = 0;
  for (std::size_t k = 0; k < one.size() && k < other.size(); ++k) {
    double away = std::fabs(one[k] - other[k]);
    const int axis = static_cast<int>(k % 3);
    if (a.cell.periodic[axis]) away = std::min(away, std::fabs(away - a.cell.length(axis)));
    most = std::max(most, away);
  }
  return most;
}

/// Collisions per ball, from how the number of contacts grows from one cycle to the next.
class Collisions {
 public:
  void look(const Engine& engine) {
    uint64_t walls = 0;
    for (const WallList& list : engine.contacts.wall_lists()) walls += list.slots.size();
    const uint64_t pairs = engine.contacts.active();
    if (seen_) {
      if (pairs > pairs_) count_ += 2 * static_cast<double>(pairs - pairs_);
      if (walls > walls_) count_ += static_cast<double>(walls - walls_);
    }
    pairs_ = pairs;
    walls_ = walls;
    seen_ = true;
  }
  bool any() const { return count_ > 0; }
  double per_ball(std::size_t balls) const { return balls > 0 ? count_ / static_cast<double>(balls) : 0; }

 private:
  double count_ = 0;
  uint64_t pairs_ = 0, walls_ = 0;
  bool seen_ = false;
};

/// How far each ball has turned. The kernel keeps no orientation, since no force of a ball depends on it: the spins of
/// the half steps are added up here, each as the exact turn about its axis over the step.
class Turns {
 public:
  explicit Turns(const Engine& engine) {
    if (engine.balls.has(Column::wx)) of_.resize(engine.balls.size(), {1, 0, 0, 0});
  }
  void follow(const Engine& engine) {
    if (of_.empty()) return;
    if (order_.empty() || rebuilds_ != engine.rebuilds()) order_ = by_id(engine.balls);
    rebuilds_ = engine.rebuilds();
    const double *x = engine.balls[Column::wx], *y = engine.balls[Column::wy], *z = engine.balls[Column::wz];
    for (std::size_t k = 0; k < of_.size(); ++k) {
      const std::size_t row = order_[k];
      const double spin = std::sqrt(x[row] * x[row] + y[row] * y[row] + z[row] * z[row]);
      if (!(spin > 0)) continue;
      const double half = 0.5 * spin * engine.clock.dt, share = std::sin(half) / spin;
      turn(of_[k], {std::cos(half), share * x[row], share * y[row], share * z[row]});
    }
  }
  std::vector<double> all() const {
    std::vector<double> out;
    for (const Quaternion& one : of_) out.insert(out.end(), one.begin(), one.end());
    return out;
  }

 private:
  using Quaternion = std::array<double, 4>;
  static void turn(Quaternion& q, const Quaternion& by) {
    const Quaternion p = q;
    q = {by[0] * p[0] - by[1] * p[1] - by[2] * p[2] - by[3] * p[3],
         by[0] * p[1] + by[1] * p[0] + by[2] * p[3] - by[3] * p[2],
         by[0] * p[2] - by[1] * p[3] + by[2] * p[0] + by[3] * p[1],
         by[0] * p[3] + by[1] * p[2] - by[2] * p[1] + by[3] * p[0]};
  }
  std::vector<Quaternion> of_;      ///< in order of ids
  std::vector<std::size_t> order_;  ///< rows in order of ids; rows move when lists are built
  uint64_t rebuilds_ = 0;
};

void describe(Horizon& out, const Engine& engine) {
  out.first_step = engine.clock.dt;
  out.dashpots = engine.local_damping() > 0;
  out.tangential = engine.contacts.book.spins();
  out.mass = in_order(engine.balls, {Column::mass});
  out.radius = median(in_order(engine.balls, {Column::radius}));
  out.start = positions(engine);
}

void refuse_signal() {
  if (stop_signal() != 0) throw Refusal(stop_exit(stop_signal()), "stopped by a signal");
}

}  // namespace

Horizon find_horizon(const Scene& scene, Scene second, Catalogue& catalogue, const RunOptions& options,
                     double longest) {
  Horizon out;
  Scene first = scene;
  const auto one = begin_scene(std::move(first), catalogue, options);
  const auto twin = begin_scene(std::move(second), catalogue, options);
  stand_before_first_cycle(*one);
  describe(out, one->engine);
  out.time = longest;
  out.reason = "the first run of the scene ends";
  if (one->engine.balls.size() == 0) return out;
  shift(twin->engine.balls);
  stand_before_first_cycle(*twin);
  Collisions collisions;
  const auto take = [&](double time, const std::string& reason) {
    if (!(time < out.time)) return;
    out.time = time;
    out.reason = reason;
  };
  // The twin may part as late as four horizons from now; what comes after `longest` cannot shorten it.
  for (uint64_t cycle = 0; one->engine.clock.time() < std::min(longest, 4 * out.time); ++cycle) {
    one->engine.forces();
    twin->engine.forces();
    collisions.look(one->engine);
    const double now = one->engine.clock.time();
    if (collisions.per_ball(one->engine.balls.size()) >= 3) take(now, "each ball has collided three times on average");
    Engine& engine = one->engine;
    const DiagonalRule usual = diagonal_rule(engine.contacts, engine.balls, engine.walls, engine.cell, engine.team);
    if (usual.step > 0 && (out.usual_step == 0 || usual.step < out.usual_step)) out.usual_step = usual.step;
    out.dashpots = out.dashpots || usual.dashpots;
    if (cycle % 10 == 0) {
      refuse_signal();
      if (largest_distance(one->engine, twin->engine) >= 1e-3 * out.radius) {
        take(now / 4, "a quarter of the time in which a change of 1e-10 R grows to 1e-3 R");
        break;
      }
    }
    one->engine.advance();
    twin->engine.advance();
  }
  out.impacts = collisions.any();
  return out;
}

Flight fly(Scene scene, Catalogue& catalogue, const RunOptions& options, uint64_t cycles, StudyRun& run) {
  Flight end;
  try {
    const auto simulation = begin_scene(std::move(scene), catalogue, options);
    stand_before_first_cycle(*simulation);
    Engine& engine = simulation->engine;
    run.step = engine.clock.dt;
    Turns turns(engine);
    const auto begun = std::chrono::steady_clock::now();
    for (uint64_t cycle = 0; cycle < cycles; ++cycle) {
      if (cycle % 64 == 0) refuse_signal();
      engine.forces();
      engine.advance();
      turns.follow(engine);
    }
    run.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    run.cycles = cycles;
    run.model_time = engine.clock.time();
    run.ball_steps = cycles * engine.balls.size();
    run.contact_updates = engine.contact_updates();
    run.state_hash = engine.state_hash();
    end = {positions(engine), turns.all()};
    const auto finite = [](double x) { return std::isfinite(x); };
    if (!std::all_of(end.positions.begin(), end.positions.end(), finite) ||
        !std::all_of(end.turned.begin(), end.turned.end(), finite)) {
      run.code = Exit::numerical;
      run.message = "positions are not finite";
      end = {};
    }
  } catch (const Refusal& refusal) {
    run.code = refusal.code();
    run.message = refusal.what();
  }
  return end;
}

}  // namespace scree::core
