#include "core/run/simulation.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/crash_note.hpp"
#include "core/base/heap.hpp"
#include "core/run/placement.hpp"
#include "core/run/rule_binding.hpp"
#include "core/run/signals.hpp"

namespace scree::core {

namespace {

bool names(const std::vector<std::string>& side, const std::string& leaf) {
  return std::any_of(side.begin(), side.end(), [&](const std::string& name) {
    return name == "balls" || name == leaf || leaf.starts_with(name + ".");
  });
}

bool names_wall(const std::vector<std::string>& side, const std::string& wall) {
  return std::any_of(side.begin(), side.end(),
                     [&](const std::string& name) { return name == "walls" || name == wall; });
}

}  // namespace

Simulation::Simulation(Scene given, Catalogue& plugins, unsigned threads, int isa)
    : scene(std::move(given)), catalogue(plugins), engine(threads, isa, [](unsigned) { use_crash_stack(); }) {
  if (scene.cell)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      engine.cell.low[axis] = scene.cell->low[axis];
      engine.cell.high[axis] = scene.cell->high[axis];
      engine.cell.periodic[axis] = scene.cell->periodic[axis];
    }
  engine.overlap_limit = scene.overlap_limit;
  engine.wanted_skin = scene.skin.value_or(0);
  engine.unsafe = scene.unsafe;
  engine.step.fixed = scene.timestep;
  engine.step.accurate = scene.accurate;
  if (scene.timestep) engine.step_place = scene.timestep_place.text();
  rules = scene.contacts;
  for (std::size_t k = 0; k < rules.size(); ++k) precedence.push_back(static_cast<uint16_t>(k));
}

void Simulation::set_up() {
  for (const WallUse& use : scene.walls) add_wall(use);
  for (const BallSet& set : scene.balls) add_balls(set);
  for (const ProcessUse& use : scene.processes) add_process(use);
  return_free_memory();
}

void Simulation::prepare() {
  bind_rules();
  engine.warn = warn;
  engine.prepare();
  prepare_processes();
}

void Simulation::prepare_processes() {
  for (std::size_t k = 0; k < engine.processes.size(); ++k) {
    const Process& process = engine.processes[k];
    if (process.table->prepare == nullptr) continue;
    engine.host.listen_to(process.name, true);
    char why[512] = "";
    const scree_refusal refusal{sizeof(scree_refusal), sizeof why, why};
    if (process.table->prepare(process.object.get(), engine.host.host(), &refusal) != 0)
      throw SceneErrors({process_uses[k].place.text() + ": error: process '" + process.name + "': " + why});
  }
}

void Simulation::add_wall(const WallUse& use) {
  Wall wall;
  wall.name = use.name;
  wall.plugin = use.wall.component->name;
  wall.table = &use.wall.component->wall();
  wall.geometry = make_object(wall.table->object, use.wall, "wall '" + use.name + "'");
  wall.velocity = use.velocity;
  wall.spin = use.spin;
  if (use.centre) wall.centre = *use.centre;
  wall.first_centre = wall.centre;
  for (const PieceProperty& property : use.contact) wall.contact[property.name] = property.value;
  engine.walls.push_back(std::move(wall));
  wall_uses.push_back(use.wall);
  engine.contacts.drop_lists();
}

void Simulation::add_balls(const BallSet& set) {
  ball_sets.push_back(set);
  groups.leaf(set.name);
  const scree_generator& generator = set.generator.component->generator();
  const auto object = make_object(generator.object, set.generator, "balls '" + set.name + "'");
  Placement placement(*this, ball_sets.back());
  const scree_sink sink = placement.sink();
  char why[1024] = "";
  const scree_refusal refusal{sizeof(scree_refusal), sizeof why, why};
  crash_note = {set.generator.component->name.c_str(), set.name.c_str()};
  const int failed = generator.generate(object.get(), &sink, &refusal);
  crash_note = CrashNote{};
  const std::string where = set.generator.place.text() + ": error: balls '" + set.name + "': ";
  if (!placement.refusal().empty()) throw SceneErrors({where + placement.refusal()});
  if (failed != 0) throw SceneErrors({where + why});
  engine.contacts.drop_lists();
}

void Simulation::add_process(const ProcessUse& use) {
  Process process;
  process.name = use.name;
  process.plugin = use.process.component->name;
  process.table = &use.process.component->process();
  process.object = make_object(process.table->object, use.process, "process '" + use.name + "'");
  process.state.assign(process.table->state_words, 0.0);
  process.sums.assign(process.table->sums, 0.0);
  engine.processes.push_back(std::move(process));
  process_uses.push_back(use.process);
}

void Simulation::bind_rules() {
  RuleBook& book = engine.contacts.book;
  const std::size_t known = book.rules.size();
  book.rules.resize(rules.size());
  for (std::size_t k = 0; k < rules.size(); ++k) {
    BoundRule now = bind_rule(*this, rules[k]);
    const bool other_words = k < known && now.varying != book.rules[k].varying;
    book.rules[k] = std::move(now);
    // Balls of another size may make a word vary that did not; the contacts that there are then need it too.
    if (other_words) engine.contacts.renew(k, engine.balls, engine.walls);
  }
  fill_tables();
}

void Simulation::fill_tables() {
  RuleBook& book = engine.contacts.book;
  const auto& leaves = groups.leaves();
  book.resize(leaves.size(), engine.walls.size());
  std::vector<uint64_t> count(leaves.size());
  for (std::size_t row = 0; row < engine.balls.size(); ++row) ++count[engine.balls.group()[row]];
  for (std::size_t a = 0; a < leaves.size(); ++a) {
    for (std::size_t b = a; b < leaves.size(); ++b)
      fill_pair(static_cast<uint16_t>(a), static_cast<uint16_t>(b), count);
    for (std::size_t w = 0; w < engine.walls.size(); ++w) {
      const std::string& wall_name = engine.walls[w].name;
      for (uint16_t index : precedence) {
        const auto& [first, second] = rules[index].between;
        if (!(names(first, leaves[a]) && names_wall(second, wall_name)) &&
            !(names(second, leaves[a]) && names_wall(first, wall_name)))
          continue;
        book.set_wall(static_cast<uint16_t>(a), static_cast<uint16_t>(w), index);
        break;
      }
      if (count[a] > 0 && book.wall(static_cast<uint16_t>(a), static_cast<uint16_t>(w)) == no_rule)
        throw Refusal(Exit::scene, scene.file + ": error: no rule says how balls '" + leaves[a] + "' and wall '" +
                                       wall_name + "' interact: add one under 'contacts', or one with 'model: none'");
    }
  }
}

void Simulation::fill_pair(uint16_t a, uint16_t b, const std::vector<uint64_t>& count) {
  RuleBook& book = engine.contacts.book;
  const std::string &one = groups.leaves()[a], &other = groups.leaves()[b];
  for (uint16_t index : precedence) {
    const auto& [first, second] = rules[index].between;
    if (!(names(first, one) && names(second, other)) && !(names(second, one) && names(first, other))) continue;
    book.set_balls(a, b, index);
    return;
  }
  const bool can_meet = a == b ? count[a] > 1 : count[a] > 0 && count[b] > 0;
  if (can_meet)
    throw Refusal(Exit::scene, scene.file + ": error: no rule says how balls '" + one + "' and '" + other +
                                   "' interact: add one under 'contacts', or one with 'model: none'");
}

double Simulation::ball_number(std::size_t row, const std::string& name) const {
  const Balls& balls = engine.balls;
  static const std::map<std::string, Column> columns = {
      {"x", Column::x},   {"y", Column::y},           {"z", Column::z},      {"vx", Column::vx},
      {"vy", Column::vy}, {"vz", Column::vz},         {"wx", Column::wx},    {"wy", Column::wy},
      {"wz", Column::wz}, {"radius", Column::radius}, {"mass", Column::mass}};
  if (name == "id") return static_cast<double>(balls.id()[row]);
  const double radius = balls[Column::radius][row];
  if (name == "volume") return 4.0 / 3.0 * 3.141592653589793 * radius * radius * radius;
  if (name == "speed")
    return std::sqrt(balls[Column::vx][row] * balls[Column::vx][row] + balls[Column::vy][row] * balls[Column::vy][row] +
                     balls[Column::vz][row] * balls[Column::vz][row]);
  const auto found = columns.find(name);
  if (found == columns.end())
    throw Refusal(Exit::scene,
                  "'" + name + "' is no number of a ball: use x y z vx vy vz wx wy wz radius mass volume speed id");
  const double* column = balls[found->second];
  return column == nullptr ? 0.0 : column[row];
}

std::vector<uint8_t> Simulation::select(const std::string& group, const Formula* where) const {
  const auto covered = groups.cover(group);
  const Balls& balls = engine.balls;
  std::vector<uint8_t> chosen(balls.size());
  std::vector<double> values;
  for (std::size_t row = 0; row < balls.size(); ++row) {
    if (!covered[balls.group()[row]]) continue;
    chosen[row] = 1;
    if (where == nullptr) continue;
    values.clear();
    for (const std::string& name : where->names()) values.push_back(ball_number(row, name));
    chosen[row] = where->evaluate(values) != 0;
  }
  return chosen;
}

Wall& Simulation::wall(const std::string& name) {
  for (Wall& candidate : engine.walls)
    if (candidate.name == name) return candidate;
  throw Refusal(Exit::scene, "there is no wall '" + name + "' now");
}

}  // namespace scree::core
