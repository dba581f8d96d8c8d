#include "core/run/rule_binding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/hash.hpp"
#include "core/base/philox.hpp"
#include "core/contact/scratch.hpp"

namespace scree::core {

namespace {

/// One input of a law, from where the scene gives it.
struct Input {
  const scree_property* property = nullptr;
  const Setting* setting = nullptr;           ///< on the rule
  std::vector<std::optional<double>> groups;  ///< on balls, by leaf; empty: not given on pieces
  bool by_ball = false;                       ///< some balls have a value each
  std::optional<Random> random{};             ///< of a distribution on the rule
};

/// What a draw depends on besides seed, rule and property: who meets, not when or in which order.
uint64_t key_of(const Birth& birth, const Balls& balls) {
  const uint64_t own = balls.id()[birth.row1];
  Hasher hasher;
  if (birth.wall != nullptr) {
    hasher.add(own);
    hasher.add(birth.patch);
    hasher.add(birth.wall->name);
  } else {
    const uint64_t other = balls.id()[birth.row2];
    hasher.add(std::min(own, other));
    hasher.add(std::max(own, other));
  }
  hasher.add(birth.bonding);
  return hasher.value();
}

double mixed(uint32_t mix, double a, double b) {
  switch (mix) {
    case SCREE_MIX_SERIES: {
      const double low = std::min(a, b), high = std::max(a, b);
      return high > 0 ? low / (1 + low / high) : 0.0;
    }
    case SCREE_MIX_LEAST:
      return std::min(a, b);
    case SCREE_MIX_MEAN:
      return 0.5 * (a + b);
    case SCREE_MIX_HARMONIC:
      return a + b > 0 ? 2 * a * b / (a + b) : 0.0;
    default:
      return a;
  }
}

bool in_form(const scree_property& property, uint32_t form) {
  return property.forms == 0 || (property.forms >> form & 1u) != 0;
}

bool is_input(const scree_property& property) { return (property.flags & SCREE_DERIVED) == 0; }

/// Everything `vary` needs, alive as long as the rule.
struct Binding {
  const Simulation* simulation;
  std::string name, model;
  Place place;
  const scree_contact_model* table;
  uint32_t form;
  std::vector<double> base;  ///< words with all uniform inputs in place
  /// Words of each piece where the model mixes whole pieces, with all uniform inputs in place; else empty.
  std::vector<double> base1, base2;
  bool from_pieces = false;       ///< some input comes from the pieces
  std::vector<Input> inputs;      ///< those that vary
  std::vector<Setting> settings;  ///< kept alive for inputs

  [[noreturn]] void refuse(const std::string& why) const {
    throw SceneErrors({place.text() + ": error: rule '" + name + "' (" + model + "): " + why});
  }

  double piece(const Input& input, uint32_t row) const {
    const Balls& balls = simulation->engine.balls;
    if (input.by_ball) {
      const auto found = balls.properties().find(input.property->name);
      if (found != balls.properties().end() && !input.groups[balls.group()[row]]) return found->second[row];
    }
    const std::optional<double>& value = input.groups[balls.group()[row]];
    if (!value && (input.property->flags & SCREE_HAS_FALLBACK) != 0) return input.property->fallback;
    if (!value)
      refuse(std::string("'") + input.property->name + "' is given neither on the rule nor on balls '" +
             simulation->groups.leaves()[balls.group()[row]] + "'");
    return *value;
  }

  /// A value as the law gets it, and what each piece gave.
  struct Value {
    double mixed, first, second;
    bool operator==(const Value& o) const { return mixed == o.mixed && first == o.first && same(second, o.second); }
    static bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }
  };
  Value value(const Input& input, const Birth& birth) const {
    if (input.random) {
      const double drawn = input.setting->drawn->draw(*input.random, key_of(birth, simulation->engine.balls));
      return {drawn, drawn, drawn};
    }
    if (input.setting != nullptr) {
      std::vector<double> values;
      for (const std::string& variable : input.setting->formula->names())
        values.push_back(variable == "x" ? birth.x : variable == "y" ? birth.y : birth.z);
      const double result = input.setting->formula->evaluate(values);
      if (!std::isfinite(result))
        refuse(std::string("'") + input.property->name + "' gives no finite number at a contact");
      return {result, result, result};
    }
    const double first = piece(input, birth.row1);
    const double second = birth.wall == nullptr ? piece(input, birth.row2) : of_wall(input, *birth.wall);
    // Only a law that mixes whole pieces is ever handed a wall without the value, and decides what that means.
    return {std::isnan(second) ? first : mixed(input.property->mix, first, second), first, second};
  }
  double of_wall(const Input& input, const Wall& wall) const {
    const auto found = wall.contact.find(input.property->name);
    if (found != wall.contact.end()) return found->second;
    if ((input.property->flags & SCREE_HAS_FALLBACK) != 0) return input.property->fallback;
    if (table->mixed == nullptr)
      refuse(std::string("'") + input.property->name + "' is given neither on the rule nor on wall '" + wall.name +
             "'");
    return std::numeric_limits<double>::quiet_NaN();
  }

  void mix_pieces(double* words, const Birth& birth) const {
    if (table->mixed == nullptr || !from_pieces) return;
    std::vector<double> piece1 = base1, piece2 = base2;
    for (const Input& input : inputs) {
      const Value v = value(input, birth);
      piece1[input.property->word] = v.first;
      piece2[input.property->word] = v.second;
    }
    char why[512] = "";
    const scree_refusal refusal{sizeof(scree_refusal), sizeof why, why};
    if (table->mixed(words, piece1.data(), piece2.data(), form, &refusal) != 0) refuse(why);
  }
  void finish(double* words, const Birth& birth) const {
    char why[512] = "";
    const scree_refusal refusal{sizeof(scree_refusal), sizeof why, why};
    if (table->prepare != nullptr && table->prepare(words, form, &refusal) != 0) refuse(why);
    if (table->derive == nullptr) return;
    const scree_pair pair{sizeof(scree_pair), 0, birth.r1, birth.r2, birth.mass};
    table->derive(words, form, &pair);
    // The SDK's way to say that the author's code threw, which `derive` has no other means to tell.
    if (std::all_of(words, words + base.size(), [](double word) { return std::isnan(word); }))
      refuse("its 'derive' threw an exception for a contact of radii " + std::to_string(birth.r1) + " and " +
             std::to_string(birth.r2) + " m: report it to the plug-in's author");
  }

  void fill(const Birth& birth, double* words) const {
    std::copy(base.begin(), base.end(), words);
    for (const Input& input : inputs) words[input.property->word] = value(input, birth).mixed;
    mix_pieces(words, birth);
    finish(words, birth);
  }

  /// The same with the largest value in place of each draw.
  void fill_largest(const Birth& birth, double* words) const {
    std::copy(base.begin(), base.end(), words);
    for (const Input& input : inputs)
      words[input.property->word] = input.random ? input.setting->drawn->largest() : value(input, birth).mixed;
    mix_pieces(words, birth);
    finish(words, birth);
  }
};

/// Values of one property on the pieces; nothing when no piece gives it.
Input from_pieces(const Simulation& simulation, const scree_property& property) {
  Input input;
  input.property = &property;
  input.groups.resize(simulation.groups.size());
  bool any = false;
  for (const BallSet& set : simulation.ball_sets)
    for (const PieceProperty& piece : set.contact) {
      if (piece.name != property.name) continue;
      any = true;
      if (piece.formula != nullptr || piece.drawn != nullptr) {
        input.by_ball = true;
        continue;
      }
      const auto covered = simulation.groups.cover(set.name);
      for (std::size_t leaf = 0; leaf < covered.size(); ++leaf)
        if (covered[leaf]) input.groups[leaf] = piece.value;
    }
  if (!any) input.groups.clear();
  return input;
}

/// Radii and pieces that this rule can meet: enough samples to see which words vary.
struct Probes {
  std::vector<Birth> births;
  bool balls = false, walls = false;
};

Probes probes_of(const Simulation& simulation, const Rule& rule) {
  const Engine& engine = simulation.engine;
  std::vector<uint8_t> covered(simulation.groups.size());
  Probes probes;
  std::vector<const Wall*> walls;
  for (const auto& side : rule.between)
    for (const std::string& name : side) {
      const auto of_name = simulation.groups.cover(name);
      for (std::size_t k = 0; k < covered.size(); ++k) covered[k] |= of_name[k];
      for (const Wall& wall : engine.walls)
        if (name == "walls" || name == wall.name) walls.push_back(&wall);
    }
  uint32_t small = no_row, large = no_row;
  const double* radius = engine.balls[Column::radius];
  for (uint32_t row = 0; row < engine.balls.size(); ++row) {
    if (!covered[engine.balls.group()[row]]) continue;
    if (small == no_row || radius[row] < radius[small]) small = row;
    if (large == no_row || radius[row] > radius[large]) large = row;
  }
  if (small == no_row) return probes;
  const auto add = [&](uint32_t a, uint32_t b, const Wall* wall) {
    Birth birth;
    birth.row1 = a;
    birth.row2 = b;
    birth.wall = wall;
    birth.r1 = radius[a];
    birth.r2 = wall == nullptr ? radius[b] : 0;
    const double mass = engine.balls[Column::mass][a];
    birth.mass = wall == nullptr ? mass * engine.balls[Column::mass][b] / (mass + engine.balls[Column::mass][b]) : mass;
    birth.x = engine.balls[Column::x][a];
    birth.y = engine.balls[Column::y][a];
    birth.z = engine.balls[Column::z][a];
    probes.births.push_back(birth);
  };
  const bool between_balls = std::all_of(rule.between.begin(), rule.between.end(), [&](const auto& side) {
    return std::any_of(side.begin(), side.end(),
                       [&](const std::string& name) { return simulation.groups.knows(name); });
  });
  if (between_balls)
    for (const auto& [a, b] : {std::pair{small, small}, {small, large}, {large, large}}) add(a, b, nullptr);
  for (const Wall* wall : walls)
    for (uint32_t row : {small, large}) add(row, no_row, wall);
  return probes;
}

// Words that differ among the probes, and every word computed from an input that varies.
std::vector<uint32_t> varying_words(const Binding& binding, const Probes& probes, std::vector<double>& most) {
  const std::size_t count = binding.base.size();
  std::vector<uint8_t> varies(count, 0);
  std::vector<double> first(count), words(count);
  most = binding.base;
  for (std::size_t k = 0; k < probes.births.size(); ++k) {
    binding.fill(probes.births[k], words.data());
    if (k == 0) first = most = words;
    for (std::size_t w = 0; w < count; ++w) {
      varies[w] |= words[w] != first[w];
      most[w] = std::max(most[w], words[w]);
    }
  }
  for (const Input& input : binding.inputs) {
    varies[input.property->word] = 1;
    // A formula that happens to be 0 where it was probed must not make a tangential part vanish.
    if (most[input.property->word] == 0) most[input.property->word] = 1;
  }
  const bool computes = binding.table->prepare != nullptr || binding.table->derive != nullptr;
  if (!binding.inputs.empty() && computes)
    for (uint32_t p = 0; p < binding.table->property_count; ++p) {
      const scree_property& property = binding.table->properties[p];
      if (!is_input(property) || !in_form(property, binding.form))
        for (uint32_t w = 0; w < property.words; ++w) varies[property.word + w] = 1;
    }
  std::vector<uint32_t> list;
  for (uint32_t w = 0; w < count; ++w)
    if (varies[w]) list.push_back(w);
  return list;
}

// Puts uniform inputs into the base and collects those that vary.
void collect_inputs(Binding& binding, const Probes& probes) {
  for (uint32_t p = 0; p < binding.table->property_count; ++p) {
    const scree_property& property = binding.table->properties[p];
    if (!is_input(property) || !in_form(property, binding.form)) continue;
    if (property.flags & SCREE_HAS_FALLBACK) binding.base[property.word] = property.fallback;
    const auto given = std::find_if(binding.settings.begin(), binding.settings.end(),
                                    [&](const Setting& s) { return s.property == p; });
    if (given != binding.settings.end()) {
      if (given->formula != nullptr || given->drawn != nullptr) {
        Input input;
        input.property = &property;
        input.setting = &*given;
        if (given->drawn != nullptr)
          input.random.emplace(binding.simulation->scene.seed, "rule/" + binding.name + "/" + property.name);
        binding.inputs.push_back(input);
      } else {
        std::copy(given->value.numbers.begin(), given->value.numbers.end(), binding.base.begin() + property.word);
      }
      continue;
    }
    if (property.mix == SCREE_MIX_NONE) continue;
    Input input = from_pieces(*binding.simulation, property);
    if (input.groups.empty()) {
      if ((property.flags & SCREE_REQUIRED) != 0 && !probes.births.empty())
        binding.refuse(std::string("'") + property.name + "' is given neither on the rule nor on its pieces");
      continue;
    }
    binding.from_pieces = true;
    binding.inputs.push_back(input);
  }
  if (binding.table->mixed != nullptr) binding.base1 = binding.base2 = binding.base;
}

// Pieces that all agree are uniform after all.
void settle_equal_pieces(Binding& binding, const Probes& probes) {
  std::vector<Input> left;
  for (const Input& input : binding.inputs) {
    bool same = input.setting == nullptr && !input.by_ball && !probes.births.empty();
    std::optional<double> group;
    if (same)
      for (const auto& value : input.groups) {
        if (!value || (group && *group != *value)) same = false;
        group = value;
      }
    Binding::Value first{};
    for (std::size_t k = 0; same && k < probes.births.size(); ++k) {
      const Binding::Value now = binding.value(input, probes.births[k]);
      if (k == 0) first = now;
      same = binding.table->mixed != nullptr ? now == first : now.mixed == first.mixed;
    }
    if (!same) {
      left.push_back(input);
      continue;
    }
    binding.base[input.property->word] = first.mixed;
    if (binding.table->mixed == nullptr) continue;
    binding.base1[input.property->word] = first.first;
    binding.base2[input.property->word] = first.second;
  }
  binding.inputs = left;
}

}  // namespace

BoundRule bind_rule(const Simulation& simulation, const Rule& rule) {
  BoundRule bound;
  bound.name = rule.name;
  if (rule.none) return bound;
  auto binding = std::make_shared<Binding>();
  binding->simulation = &simulation;
  binding->name = rule.name;
  binding->model = rule.model.component->name;
  binding->place = rule.place;
  binding->table = &rule.model.component->contact_model();
  binding->form = rule.model.form;
  binding->settings = rule.model.settings;
  binding->base.assign(binding->table->rule_words, 0.0);
  bound.model = binding->table;
  bound.model_name = binding->model;
  if (binding->table->state_words + binding->table->bond_words > Scratch::state_words ||
      binding->table->rule_words > 2 * Scratch::state_words)
    throw Refusal(Exit::plugin, "contact model '" + binding->model + "' has more than " +
                                    std::to_string(Scratch::state_words) + " state words or " +
                                    std::to_string(2 * Scratch::state_words) +
                                    " property words, which this scree cannot hold");
  const Probes probes = probes_of(simulation, rule);
  collect_inputs(*binding, probes);
  settle_equal_pieces(*binding, probes);
  std::vector<double> most;
  bound.varying = varying_words(*binding, probes, most);
  bound.words = binding->base;
  if (!probes.births.empty()) {
    binding->fill(probes.births[0], bound.words.data());
    bound.needs = bound.model->needs != nullptr ? bound.model->needs(most.data()) : bound.model->flags;
    if (bound.model->reach != nullptr)
      for (const Birth& birth : probes.births) {
        std::vector<double> words(binding->base.size());
        binding->fill_largest(birth, words.data());
        const scree_pair pair{sizeof(scree_pair), 0, birth.r1, birth.r2, birth.mass};
        bound.reach = std::max(bound.reach, bound.model->reach(words.data(), &pair));
      }
  } else {
    bound.needs = SCREE_NORMAL_ONLY | bound.model->flags;
  }
  // A bond needs what the law without friction could do without.
  if (bound.can_bond()) bound.needs = bound.model->flags;
  if (bound.model->normal_only[0] == nullptr) bound.needs &= ~static_cast<uint32_t>(SCREE_NORMAL_ONLY);
  bound.drawn = std::any_of(binding->inputs.begin(), binding->inputs.end(),
                            [](const Input& input) { return input.setting != nullptr || input.by_ball; });
  // Also where nothing varies now: a checkpoint may say that something does.
  bound.vary = [binding](const Birth& birth, double* words) { binding->fill(birth, words); };
  return bound;
}

}  // namespace scree::core
