#include "core/cycle/step_schedule.hpp"

#include <algorithm>

namespace scree::core {

namespace {

// Cost in force passes, as measured: an estimate without sweeps, and each sweep. The share of a run that they may take
// follows from the cycles since the last one.
constexpr double base_cost = 6, sweep_cost = 2, share = 0.03;
constexpr unsigned most_sweeps = 20;
/// Of the least radius: margin of what does not move. Laws that stiffen are taken as much deeper than they are, and the
/// overlaps of Hertz contacts under a pascal are a ten-millionth of the radius.
constexpr double least_margin = 1e-9;

}  // namespace

double StepSchedule::closed() const { return std::max(2 * balls_, balls_ + walls_); }

NetworkQuery StepSchedule::plan(uint64_t cycle, const Motion& motion) {
  NetworkQuery query;
  query.sweeps = most_sweeps;
  // What is done to the scene between two cycles is one occasion.
  if (made_ > 0 && cycle == last_) {
    query.sweeps = static_cast<unsigned>(made_ - 1);
  } else if (made_ > 0) {
    const double credit = share * static_cast<double>(cycle - last_) - base_cost;
    query.sweeps = static_cast<unsigned>(std::clamp(credit / sweep_cost, 0.0, static_cast<double>(most_sweeps)));
  }
  // Long enough for the sweeps to pay, and narrow where that is cheap; never beyond what is listed.
  const double wanted = std::max(200 * motion.closing, std::min(1000 * motion.closing, 0.02 * motion.radius));
  margin_ = std::min(motion.skin_left, std::max(least_margin * motion.radius, wanted));
  query.links.margin = margin_;
  balls_ = walls_ = 0;
  last_ = cycle;
  made_ = query.sweeps + 1;
  return query;
}

void StepSchedule::moved(double balls, double walls) {
  balls_ += balls;
  walls_ += walls;
}

void StepSchedule::restore(const State& state) {
  margin_ = state.margin;
  balls_ = state.balls;
  walls_ = state.walls;
  last_ = state.last;
  made_ = state.made;
}

}  // namespace scree::core
