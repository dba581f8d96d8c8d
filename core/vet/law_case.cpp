#include "core/vet/law_case.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "core/base/log.hpp"
#include "core/vet/outcome.hpp"

namespace scree::core::vet {

namespace {

constexpr double pi = 3.14159265358979323846;

struct Scale {
  std::string_view unit;
  double low, high;
};
/// What values of a unit are like in a granular model of millimetres to decimetres.
constexpr std::array scales = {
    Scale{"N/m", 1e5, 1e7},   Scale{"N m-1", 1e5, 1e7}, Scale{"Pa", 1e7, 1e9},     Scale{"Pa/m", 1e9, 1e11},
    Scale{"N/m3", 1e9, 1e11}, Scale{"N", 1e-2, 1e2},    Scale{"m", 1e-6, 1e-5},    Scale{"N m", 1e-4, 1e-1},
    Scale{"N m/rad", 1, 1e3}, Scale{"J/m2", 1e-2, 1},   Scale{"N/m2", 1e6, 1e9},   Scale{"s", 1e-3, 1},
    Scale{"m/s", 1e-2, 1},    Scale{"Pa s", 1e2, 1e5},  Scale{"N s/m", 1e0, 1e3},  Scale{"degree", 5, 40},
    Scale{"rad", 0.1, 0.7},   Scale{"1", 0.2, 0.9},     Scale{"kg/m3", 1500, 3000}};

Scale scale_of(const char* unit) {
  for (const Scale& scale : scales)
    if (scale.unit == unit) return scale;
  return {unit, 0.5, 2};
}

bool has(const scree_property& p, uint32_t flag) { return (p.flags & flag) != 0; }
bool is_input(const scree_property& p, uint32_t form) {
  return !has(p, SCREE_DERIVED) && (p.forms == 0 || (p.forms >> form & 1u) != 0);
}

/// Within the bounds, and off an end that does not belong to them.
double clamped(const scree_property& p, double value) {
  const double room = has(p, SCREE_HAS_LOW) && has(p, SCREE_HAS_HIGH) ? p.high - p.low : 1e-3 * std::abs(value);
  if (has(p, SCREE_HAS_HIGH)) value = std::min(value, has(p, SCREE_HIGH_OPEN) ? p.high - 0.01 * room : p.high);
  if (has(p, SCREE_HAS_LOW)) value = std::max(value, has(p, SCREE_LOW_OPEN) ? p.low + 0.01 * room : p.low);
  return value;
}

double random_value(const scree_property& p, Numbers& random) {
  const bool low = has(p, SCREE_HAS_LOW), high = has(p, SCREE_HAS_HIGH);
  if (p.type == SCREE_BOOLEAN) return random.chance(0.5) ? 1 : 0;
  if (p.type == SCREE_INTEGER) {
    const double first = low ? p.low : has(p, SCREE_HAS_FALLBACK) ? p.fallback : 0, last = high ? p.high : first + 3;
    return std::floor(random.between(first, std::min(last, first + 8) + 1));
  }
  if (has(p, SCREE_POSITIVE_INFINITY) && random.chance(0.3)) return std::numeric_limits<double>::infinity();
  const Scale scale = scale_of(p.unit);
  if (scale.unit == "1" && low && high) return clamped(p, random.between(p.low, p.high));
  const double value = random.spread(scale.low, scale.high);
  // What may be negative is so half of the time.
  return clamped(p, !low && random.chance(0.5) ? -value : value);
}

/// The inputs of one form; `value` says what each is given.
template <class Value>
Case filled(const scree_contact_model& model, uint32_t form, Value value) {
  Case c;
  c.model = &model;
  c.form = form;
  c.words.assign(model.rule_words, 0.0);
  for (uint32_t k = 0; k < model.property_count; ++k) {
    const scree_property& p = model.properties[k];
    if (!is_input(p, form)) continue;
    for (uint32_t w = 0; w < p.words; ++w) c.words[p.word + w] = value(p);
    if ((p.type == SCREE_INTEGER || p.type == SCREE_BOOLEAN) && has(p, SCREE_HAS_FALLBACK))
      c.usual = c.usual && c.words[p.word] == p.fallback;
    c.text += fmt::format("{}{}={:.6g}", c.text.empty() ? "" : " ", p.name, c.words[p.word]);
  }
  return c;
}

void give_pieces(Case& c, double r1, double r2, double density) {
  const auto mass = [&](double r) { return density * 4 / 3 * pi * r * r * r; };
  c.r1 = r1;
  c.r2 = r2;
  c.mass = r2 == 0 ? mass(r1) : mass(r1) * mass(r2) / (mass(r1) + mass(r2));
  c.text += fmt::format("; radii {:.4g} and {:.4g} m", r1, r2);
}

/// The rest follows from inputs and pieces; the reason when `prepare` refuses.
std::string finish(Case& c) {
  c.inputs = c.words;
  char why[512] = "";
  const scree_refusal refusal{sizeof(scree_refusal), sizeof why, why};
  if (c.model->prepare != nullptr && c.model->prepare(c.words.data(), c.form, &refusal) != 0)
    return why[0] != 0 ? why : "no reason given";
  const scree_pair pair{sizeof(scree_pair), 0, c.r1, c.r2, c.mass};
  if (c.model->derive != nullptr) c.model->derive(c.words.data(), c.form, &pair);
  if (c.model->reach != nullptr) c.reach = c.model->reach(c.words.data(), &pair);
  LawBench bench(*c.model, parts(*c.model).back(), 1, c.words);
  Seen deep = c.seen();
  deep.gap = -c.depth;
  bench.put(0, deep);
  c.stiffness = bench.tangent(0).normal;
  const double period = c.stiffness > 0 ? std::sqrt(c.mass / c.stiffness) : 1e-3;
  c.dt = std::isfinite(period) ? 0.05 * period : 1e-5;
  return "";
}

uint32_t form_count(const scree_contact_model& model) { return std::max<uint32_t>(model.form_count, 1); }

}  // namespace

Seen Case::seen() const {
  Seen s;
  s.r1 = r1;
  s.r2 = r2;
  s.mass = mass;
  return s;
}

Case Case::exchanged() const {
  Case other = *this;
  other.words = inputs;
  std::swap(other.r1, other.r2);
  finish(other);
  return other;
}

std::vector<Part> parts(const scree_contact_model& model) {
  if ((model.flags & SCREE_CAN_BOND) != 0) return {Part::touch, Part::bonded};
  return {Part::touch};
}

std::vector<Case> cases(const scree_contact_model& model, std::size_t count, uint64_t seed) {
  Numbers random(seed);
  std::vector<Case> list;
  std::string why;
  for (std::size_t tries = 0; list.size() < count && tries < 50 * count; ++tries) {
    Case c = filled(model, static_cast<uint32_t>(list.size()) % form_count(model), [&](const scree_property& p) {
      return has(p, SCREE_HAS_FALLBACK) && random.chance(0.4) ? p.fallback : random_value(p, random);
    });
    const double r1 = random.spread(2e-3, 5e-2);
    give_pieces(c, r1, random.chance(0.25) ? 0.0 : r1 * random.spread(0.5, 2), 2500);
    c.depth = (c.r2 > 0 ? std::min(c.r1, c.r2) : c.r1) * random.spread(2e-4, 2e-3);
    why = finish(c);
    if (why.empty()) list.push_back(std::move(c));
  }
  if (list.empty())
    throw Failed("'prepare' refuses every input within the declared bounds that was tried: " + why,
                 "declare narrower bounds, or refuse less");
  return list;
}

std::vector<Case> extreme_cases(const scree_contact_model& model) {
  std::vector<Case> list;
  const auto end_of = [](const scree_property& p, unsigned which) {
    const Scale scale = scale_of(p.unit);
    const bool whole = p.type == SCREE_INTEGER || p.type == SCREE_BOOLEAN;
    if (which == 0) return clamped(p, has(p, SCREE_HAS_LOW) ? p.low : whole ? 0.0 : -1e2 * scale.high);
    if (which == 2 && has(p, SCREE_POSITIVE_INFINITY)) return std::numeric_limits<double>::infinity();
    if (whole) return has(p, SCREE_HAS_HIGH) ? p.high : has(p, SCREE_HAS_FALLBACK) ? p.fallback : 1.0;
    return clamped(p, has(p, SCREE_HAS_HIGH) ? p.high : 1e2 * scale.high);
  };
  for (uint32_t form = 0; form < form_count(model); ++form)
    for (unsigned trial = 0; trial < 24; ++trial) {
      Numbers random(trial);
      Case c = filled(model, form, [&](const scree_property& p) {
        // The first three put every input at the same end; the others mix ends and middles.
        return trial < 3            ? end_of(p, trial)
               : random.chance(0.6) ? end_of(p, static_cast<unsigned>(random.below(3)))
                                    : random_value(p, random);
      });
      const double r1 = trial % 3 == 0 ? 1e-5 : trial % 3 == 1 ? 1e-2 : 10;
      give_pieces(c, r1, trial % 4 == 3 ? 0.0 : r1 * (trial % 2 ? 1 : 1e-3), 2500);
      c.depth = 1e-3 * (c.r2 > 0 ? std::min(c.r1, c.r2) : c.r1);
      if (finish(c).empty()) list.push_back(std::move(c));
    }
  if (list.empty()) throw Skipped("'prepare' refuses every input at the ends of the declared bounds");
  return list;
}

}  // namespace scree::core::vet
