#include "core/cycle/monitors.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/philox.hpp"
#include "core/contact/honesty.hpp"
#include "core/cycle/engine.hpp"

namespace scree::core {

namespace {

constexpr double alarm = 3.6;              ///< of 4
constexpr double slack = 1.05;             ///< beyond what the bound promises
constexpr double least_way = 1e-8;         ///< of the least radius in one cycle: below, rounding moves more
constexpr double warned_share = 1.2;       ///< of the stiffness that a law reports
constexpr double stopped_share = 2;        ///< beyond this the automatic step is above the limit for sure
constexpr uint64_t contacts_each = 10000;  ///< for one that is looked at

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

FrequencyWatch::Sums FrequencyWatch::sums(const Balls& balls, Slices& slices, Team& team) {
  std::vector<Sums> parts(slices.blocks());
  const std::size_t words = slices.stride() == Slices::with_spin && balls.has(Column::wx) ? 6 : 3;
  const double* v[6];
  for (std::size_t c = 0; c < words; ++c)
    v[c] = balls[static_cast<Column>(static_cast<std::size_t>(c < 3 ? Column::vx : Column::wx) + c % 3)];
  const double *mass = balls[Column::mass], *radius = balls[Column::radius];
  const uint8_t* fixed = balls.fixed();
  team.each_block(slices.blocks(), [&](std::size_t block) {
    slices.fold(block);
    Sums& s = parts[block];
    const std::size_t first = block * block_rows;
    for (std::size_t row = first; row < first + slices.block_size(block); ++row) {
      const double* force = slices.record(row);
      double square[2] = {0, 0};
      for (std::size_t c = 0; c < words; ++c) {
        if (fixed != nullptr && (fixed[row] >> c & 1u) != 0) continue;  // it moves whatever the force
        s.power += v[c][row] * force[c];
        square[c / 3] += v[c][row] * v[c][row];
      }
      s.inertia += mass[row] * (square[0] + 0.4 * radius[row] * radius[row] * square[1]);
      s.mass += mass[row];
    }
  });
  Sums all;
  for (const Sums& s : parts) all = {all.power + s.power, all.inertia + s.inertia, all.mass + s.mass};
  return all;
}

void FrequencyWatch::note(const Balls& balls, Slices& slices, Team& team) {
  power_ = sums(balls, slices, team).power;
  noted_ = true;
}

double FrequencyWatch::measure(const Balls& balls, Slices& slices, double dt, double least_radius, Team& team) {
  noted_ = false;
  const Sums now = sums(balls, slices, team);
  const double least = least_way * least_radius;
  if (!(now.inertia * dt * dt > now.mass * least * least)) return 0;
  return dt * (power_ - now.power) / now.inertia;
}

void Engine::watch_frequency() {
  const double q =
      (1 + local_damping()) * frequency_.measure(balls, contacts.slices(), clock.dt_back, least_radius_, team);
  const double bound = step.bound().step, share = bound > 0 ? clock.dt_back / bound : 0.0;
  // Up to its limit a step may show what the bound promises.
  const double limit = share > 0 && share <= 1 ? std::max(alarm, slack * 4 * share * share) : alarm;
  if (!frequency_.beyond(q > limit)) return;
  std::size_t fastest = 0;
  double most = -1;
  for (std::size_t row = 0; row < balls.size(); ++row) {
    double square = 0;
    for (const Column c : {Column::vx, Column::vy, Column::vz}) square += balls[c][row] * balls[c][row];
    if (square * balls[Column::mass][row] > most) {
      most = square * balls[Column::mass][row];
      fastest = row;
    }
  }
  const uint64_t id = balls.size() > 0 ? balls.id()[fastest] : 0;
  throw NumericalStop("cycle " + std::to_string(clock.cycle) +
                          ": the motion swings as it does beyond the stable step: its apparent frequency times the "
                          "step, squared, is " +
                          number(q) + " in four cycles in a row (4 at the limit, stop at " + number(limit) +
                          "); most of it is in ball " + std::to_string(id) + "; the step is " + number(clock.dt) +
                          " s, the stable limit " + number(bound) + " s (" + step.bound().text() +
                          "): lower 'timestep' or leave it out for the automatic step; if it is automatic, check the "
                          "stiffness that your contact models report with scree vet",
                      {id}, NumericalStop::State::whole);
}

void Engine::watch_honesty() {
  const uint64_t listed = contacts.listed();
  if (listed == 0) return;
  honesty_.warned.resize(contacts.book.rules.size(), 0);
  const Random random(0, "monitor/stiffness");
  for (uint64_t k = 0; k < 1 + listed / contacts_each; ++k) {
    const auto at = static_cast<uint64_t>(random.uniform(clock.cycle, k) * static_cast<double>(listed));
    const Honesty found = look_at_stiffness(contacts, balls, cell, at, clock.dt);
    if (!(found.share() > warned_share) || honesty_.warned[found.rule] != 0) continue;
    const BoundRule& rule = contacts.book.rules[found.rule];
    const std::string what = "cycle " + std::to_string(clock.cycle) + ": contact model '" + rule.model_name +
                             "' of rule '" + rule.name + "' has a " + found.part + " stiffness of " +
                             number(found.measured) + " N/m between balls " + std::to_string(found.id1) + " and " +
                             std::to_string(found.id2) + " and reports " + number(found.reported) +
                             " N/m, so the automatic step is not safe: ";
    if (found.share() > stopped_share)
      throw Refusal(Exit::plugin, what + "give a smaller 'timestep', and report it to the plug-in's author");
    honesty_.warned[found.rule] = 1;
    warn(what + "look at the plug-in with scree vet");
  }
}

}  // namespace scree::core
