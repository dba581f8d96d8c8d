#include "core/contact/rule.hpp"

#include <algorithm>

namespace scree::core {

namespace {
// Null means "use the one before".
scree_law pick(const scree_law (&table)[3], int isa) {
  for (int k = isa; k >= 0; --k)
    if (table[k] != nullptr) return table[k];
  return nullptr;
}
}  // namespace

void BoundRule::refresh(int isa) {
  if (model == nullptr) return;
  const bool same = varying.empty();
  if (normal_only()) {
    law = energy_law = pick(model->normal_only, isa);
  } else {
    law = same ? pick(model->uniform, isa) : pick(model->varying, isa);
    energy_law = same ? pick(model->uniform_energy, isa) : pick(model->varying_energy, isa);
  }
  bonded_law = same ? pick(model->bonded, isa) : pick(model->bonded_varying, isa);
  constants = Array<double>(words.size() * SCREE_BATCH);
  for (std::size_t w = 0; w < words.size(); ++w)
    for (std::size_t k = 0; k < SCREE_BATCH; ++k) constants[w * SCREE_BATCH + k] = words[w];
}

void RuleBook::resize(std::size_t groups, std::size_t walls) {
  groups_ = groups;
  wall_count_ = walls;
  balls_.assign(groups * groups, no_rule);
  walls_.assign(groups * walls, no_rule);
}

void RuleBook::set_balls(uint16_t a, uint16_t b, uint16_t rule) {
  balls_[static_cast<std::size_t>(a) * groups_ + b] = rule;
  balls_[static_cast<std::size_t>(b) * groups_ + a] = rule;
}

void RuleBook::set_wall(uint16_t group, uint16_t wall, uint16_t rule) {
  walls_[static_cast<std::size_t>(group) * wall_count_ + wall] = rule;
}

double RuleBook::reach() const {
  double most = 0;
  for (const BoundRule& rule : rules) most = std::max(most, rule.reach);
  return most;
}

bool RuleBook::spins() const {
  return std::any_of(rules.begin(), rules.end(),
                     [](const BoundRule& rule) { return rule.model != nullptr && !rule.normal_only(); });
}

}  // namespace scree::core
