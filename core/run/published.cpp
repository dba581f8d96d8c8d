#include "core/run/published.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/run/piece_quantities.hpp"

namespace scree::core {

namespace {

using V = std::array<double, 3>;

constexpr Needs free{}, pass{false, false, true}, sums{true, false, true}, report{false, true, true};

struct Plain {
  const char *name, *unit;
  Needs needs;
  double (*read)(Simulation&, Instant&);
};

double count(std::size_t n) { return static_cast<double>(n); }

double ball_sum(const Balls& balls, double (*term)(double radius, double mass)) {
  double sum = 0;
  for (std::size_t row = 0; row < balls.size(); ++row)
    sum += term(balls[Column::radius][row], balls[Column::mass][row]);
  return sum;
}

double coordination(Simulation& s, Instant& now) {
  if (s.engine.balls.size() == 0) return 0;
  return count(2 * now.between_balls() + now.with_walls()) / count(s.engine.balls.size());
}

double sliding(Simulation&, Instant& now) {
  std::size_t n = 0;
  for (const ActiveContact& contact : now.contacts()) n += contact.sliding;
  return count(n);
}

const Plain plain[] = {
    {"time", "s", free, [](Simulation& s, Instant&) { return s.engine.clock.time(); }},
    {"cycle", "1", free, [](Simulation& s, Instant&) { return static_cast<double>(s.engine.clock.cycle); }},
    {"timestep", "s", free, [](Simulation& s, Instant&) { return s.engine.clock.dt; }},
    {"rebuilds", "1", free, [](Simulation& s, Instant&) { return static_cast<double>(s.engine.rebuilds()); }},
    {"unbalanced", "1", sums, [](Simulation&, Instant& now) { return now.observation().unbalanced; }},
    {"unbalanced.max", "1", sums, [](Simulation&, Instant& now) { return now.observation().unbalanced_max; }},
    {"kinetic_energy", "J", pass, [](Simulation&, Instant& now) { return now.observation().kinetic; }},
    {"kinetic_energy.shadow", "J", pass, [](Simulation&, Instant& now) { return now.observation().kinetic_shadow; }},
    {"mass", "kg", pass,
     [](Simulation& s, Instant&) { return ball_sum(s.engine.balls, [](double, double m) { return m; }); }},
    {"volume.balls", "m3", pass,
     [](Simulation& s, Instant&) {
       return 4 * std::numbers::pi / 3 * ball_sum(s.engine.balls, [](double r, double) { return r * r * r; });
     }},
    {"balls.count", "1", free, [](Simulation& s, Instant&) { return count(s.engine.balls.size()); }},
    {"contacts.count", "1", pass,
     [](Simulation&, Instant& now) { return count(now.between_balls() + now.with_walls()); }},
    {"contacts.balls", "1", pass, [](Simulation&, Instant& now) { return count(now.between_balls()); }},
    {"contacts.walls", "1", pass, [](Simulation&, Instant& now) { return count(now.with_walls()); }},
    {"contacts.listed", "1", free, [](Simulation& s, Instant&) { return count(s.engine.contacts.listed()); }},
    {"contacts.sliding", "1", report, sliding},
    {"bonds.count", "1", pass, [](Simulation& s, Instant&) { return count(s.engine.contacts.bonded()); }},
    {"bonds.broken", "1", pass,
     [](Simulation& s, Instant&) {
       return count(s.engine.contacts.broken_bonds[0] + s.engine.contacts.broken_bonds[1]);
     }},
    {"bonds.broken.tension", "1", pass,
     [](Simulation& s, Instant&) { return count(s.engine.contacts.broken_bonds[0]); }},
    {"bonds.broken.shear", "1", pass, [](Simulation& s, Instant&) { return count(s.engine.contacts.broken_bonds[1]); }},
    {"coordination", "1", pass, coordination},
    {"overlap.max", "1", pass, [](Simulation&, Instant& now) { return now.overlap(); }},
};

V momentum(const Balls& balls, const Observation& seen) {
  V sum{};
  for (std::size_t row = 0; row < balls.size(); ++row)
    for (std::size_t c = 0; c < 3; ++c) sum[c] += balls[Column::mass][row] * seen.velocity[c][row];
  return sum;
}

/// About the origin; a ball's own part is that of a solid sphere.
V angular_momentum(const Balls& balls, const Observation& seen) {
  V sum{};
  const bool spin = seen.spin[0].size() == balls.size();
  for (std::size_t row = 0; row < balls.size(); ++row) {
    const double mass = balls[Column::mass][row], radius = balls[Column::radius][row];
    const V x{balls[Column::x][row], balls[Column::y][row], balls[Column::z][row]};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t a = (c + 1) % 3, b = (c + 2) % 3;
      sum[c] += mass * (x[a] * seen.velocity[b][row] - x[b] * seen.velocity[a][row]);
      if (spin) sum[c] += 0.4 * mass * radius * radius * seen.spin[c][row];
    }
  }
  return sum;
}

struct Vectors {
  const char *name, *unit;
  V (*read)(const Balls&, const Observation&);
};
const Vectors vectors[] = {{"momentum", "kg m/s", momentum}, {"angular_momentum", "kg m2/s", angular_momentum}};

// The terms of the energy balance, while a process traces it.
std::optional<Published> find_energy(const std::string& name, Simulation& simulation) {
  if (!simulation.engine.ledger.on || !name.starts_with("energy.")) return std::nullopt;
  const std::string term = name.substr(7);
  const auto& terms = EnergyBalance::terms();
  const bool share = term == "residual_share";
  if (term != "residual" && !share && std::find(terms.begin(), terms.end(), term) == terms.end()) return std::nullopt;
  return Published{share ? "1" : "J", pass, [&simulation, term] {
                     return simulation.engine.ledger.value(term, simulation.engine.stored_energy());
                   }};
}

std::optional<Published> find_plain(const std::string& name, Simulation& simulation, Instant& now) {
  for (const Plain& one : plain)
    if (name == one.name)
      return Published{one.unit, one.needs, [&simulation, &now, &one] { return one.read(simulation, now); }};
  for (const Vectors& one : vectors)
    for (std::size_t c = 0; c < 3; ++c)
      if (name == std::string(one.name) + "." + "xyz"[c])
        return Published{one.unit, pass, [&simulation, &now, &one, c] {
                           return one.read(simulation.engine.balls, now.observation())[c];
                         }};
  return std::nullopt;
}

}  // namespace

std::optional<Published> find_published(const std::string& name, Simulation& simulation, Instant& instant) {
  if (auto found = find_plain(name, simulation, instant)) return found;
  if (auto found = find_energy(name, simulation)) return found;
  if (auto found = find_wall_quantity(name, simulation.engine)) return found;
  if (auto found = find_ball_quantity(name, simulation.engine, instant)) return found;
  if (auto found = find_contact_quantity(name, simulation.engine, instant)) return found;
  const auto& published = simulation.engine.host.published;
  if (!published.contains(name)) return std::nullopt;
  return Published{"", free, [&published, name] {
                     const auto found = published.find(name);
                     return found == published.end() ? std::nan("") : found->second;
                   }};
}

std::vector<std::string> published_names(const Simulation& simulation, const std::string& like) {
  std::vector<std::string> names;
  for (const Plain& one : plain) names.emplace_back(one.name);
  for (const Vectors& one : vectors)
    for (const char axis : {'x', 'y', 'z'}) names.push_back(std::string(one.name) + "." + axis);
  if (simulation.engine.ledger.on) {
    for (const std::string& term : EnergyBalance::terms()) names.push_back("energy." + term);
    names.insert(names.end(), {"energy.residual", "energy.residual_share"});
  }
  for (const Wall& wall : simulation.engine.walls) add_wall_names(wall.name, names);
  for (const auto& [name, value] : simulation.engine.host.published) names.push_back(name);
  add_piece_names(like, names);
  return names;
}

}  // namespace scree::core
