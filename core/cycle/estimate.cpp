#include <algorithm>
#include <cmath>

#include "core/contact/holding.hpp"
#include "core/contact/network_bound.hpp"
#include "core/cycle/engine.hpp"
#include "core/cycle/impact_share.hpp"

// The estimate that the step is taken from.

namespace scree::core {

namespace {

constexpr double travel = 0.4;  ///< of its own radius, by a ball in one cycle

}  // namespace

double Engine::fastest_ball() const {
  const double *x = balls[Column::vx], *y = balls[Column::vy], *z = balls[Column::vz];
  double most = 0;
  for (std::size_t row = 0; row < balls.size(); ++row)
    most = std::max(most, x[row] * x[row] + y[row] * y[row] + z[row] * z[row]);
  return std::sqrt(most);
}

// The ball that crosses its own radius first, and in what time.
StepBound Engine::flight() const {
  const double *x = balls[Column::vx], *y = balls[Column::vy], *z = balls[Column::vz], *radius = balls[Column::radius];
  double most = 0;
  std::size_t at = 0;
  for (std::size_t row = 0; row < balls.size(); ++row) {
    const double now = (x[row] * x[row] + y[row] * y[row] + z[row] * z[row]) / (radius[row] * radius[row]);
    if (!(now > most)) continue;
    most = now;
    at = row;
  }
  if (!(most > 0)) return {};
  // Lists that are rebuilt a cycle ahead show what two such balls may meet only within the skin.
  return {std::min(travel / std::sqrt(most), 0.5 * skin_.width() / fastest_ball()),
          balls.id()[at],
          0,
          "",
          "kinematic",
          false};
}

StepBound Engine::estimate() {
  double walls_move = 0;
  for (const Wall& wall : walls) walls_move = std::max(walls_move, wall.travel(clock.dt, extent_));
  const double ball_moves = fastest_ball() * clock.dt;
  const double used = std::max(2 * ball_travel_, ball_travel_ + wall_travel_);
  const uint64_t lasted = clock.cycle - schedule_.state().last;
  NetworkQuery query = schedule_.plan(clock.cycle, {std::max(2 * ball_moves, ball_moves + walls_move),
                                                    std::clamp(skin_.width() - used, 0.0, skin_.far()), least_radius_});
  query.local_damping = local_damping();
  if (const auto bound = crowded(query, lasted)) return smaller(*bound, flight());
  crowd_use_.rests = 0;
  const bool few = coordination(contacts, balls, cell) < few_contacts;
  // The user's own step is held to what is stable, not to what is accurate.
  if (step.automatic()) {
    query.links.birth_depth = birth_depth;
    query.links.impact_share = step.accurate ? accurate_share : few ? impact_share : 0.0;
  }
  if (few) query.sweeps = std::min(query.sweeps, 3u);
  const NetworkBound found = weigh(query);
  if (found.links == 0)
    estimated_ = "no contact is within reach: nothing is estimated";
  else
    estimated_ = std::to_string(found.links) + " contacts, " + std::to_string(found.sweeps) +
                 (found.sweeps == 1 ? " sweep" : " sweeps") +
                 (few ? ", no more as there are fewer than two contacts a ball" : "");
  // Where balls meet rarely, what they could meet keeps the step steady between two meetings.
  const bool wide = few || !step.automatic();
  const StepBound stable = wide || found.network.step == 0 ? smaller(found.network, possible_) : found.network;
  // A ball that flies towards nothing must not pass through what it meets, and the guard stops it at half a radius.
  const StepBound flown = step.automatic() ? flight() : StepBound();
  return smaller(smaller(stable, flown), smaller(found.impact, found.kinematic));
}

// The limit, or where the step can only stay or rise later, whether it holds: that is asked much faster.
NetworkBound Engine::weigh(NetworkQuery& query) {
  const double least = step.automatic() ? step.enough(clock.cycle) : 0.0;
  if (query.sweeps > 0 || least == 0 || contacts.slices().rows() != balls.size())
    return network_bound(contacts, balls, walls, cell, query, team);
  const double now = step.holding();
  const Holding found =
      step_holds(contacts, balls, walls, cell, query.links, query.local_damping, now, least / now, team);
  if (!found.holds) {
    query.enough = now;
    return network_bound(contacts, balls, walls, cell, query, team);
  }
  NetworkBound out;
  if (found.links > 0) out.network = {found.larger ? least : now, 0, 0, "", "network", true};
  out.impact = found.impact;
  out.kinematic = found.kinematic;
  out.links = found.links;
  return out;
}

}  // namespace scree::core
