#include "core/run/rule_doubts.hpp"

#include <algorithm>
#include <cstdio>

namespace scree::core {

namespace {

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

const Setting* setting(const Rule& rule, const char* name) {
  const auto& all = rule.model.settings;
  const auto found = std::find_if(all.begin(), all.end(), [&](const Setting& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

/// The one value that the rule gives; `other` when it gives none or one that varies.
double value_of(const Rule& rule, const char* name, double other) {
  const Setting* found = setting(rule, name);
  const bool one = found != nullptr && found->formula == nullptr && found->drawn == nullptr;
  return one && !found->value.numbers.empty() ? found->value.numbers[0] : other;
}

/// A rule that gives friction but has no tangential part: it lacks the shear spring that friction limits.
bool friction_in_vain(const Rule& rule, const BoundRule& bound) {
  return bound.normal_only() && setting(rule, "fric") != nullptr && value_of(rule, "fric", 1) > 0;
}

}  // namespace

std::vector<std::string> rule_doubts(const Simulation& simulation) {
  std::vector<std::string> out;
  for (const uint16_t index : simulation.precedence) {
    const Rule& rule = simulation.rules[index];
    const BoundRule& bound = simulation.engine.contacts.book.rules[index];
    if (bound.model == nullptr) continue;
    const std::string begin = rule.place.text() + ": warning: rule '" + rule.name + "' ";
    if (friction_in_vain(rule, bound))
      out.push_back(begin +
                    "gives friction but no shear stiffness, so friction has no effect: give a shear stiffness, or "
                    "leave 'fric' out");
    const double damping = value_of(rule, "dp_nratio", 0), mode = value_of(rule, "dp_mode", 0);
    if (damping >= 1 && (mode == 0 || mode == 2))
      out.push_back(begin + "has a dashpot of " + number(damping) +
                    " of the critical one that may pull, so pieces that meet stick to each other: give dp_mode 1 or 3, "
                    "or a smaller 'dp_nratio'");
    const double width = value_of(rule, "pb_rmul", 1);
    if (width > 1)
      out.push_back(begin + "makes bonds " + number(width) +
                    " times as wide as the smaller ball: the bond then reaches beyond it; give a 'pb_rmul' of at "
                    "most 1");
  }
  return out;
}

}  // namespace scree::core
