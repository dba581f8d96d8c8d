#include "core/cycle/energy_balance.hpp"

#include <algorithm>
#include <cmath>

namespace scree::core {

void CarefulSum::add(double value) {
  const double next = sum + value;
  rest += std::fabs(sum) >= std::fabs(value) ? (sum - next) + value : (value - next) + sum;
  sum = next;
}

void EnergyBalance::add_contacts(const ContactEnergy& pass) {
  total_[friction].add(pass.friction);
  total_[dashpot].add(pass.dashpot);
  total_[broken].add(pass.broken);
  passed_.add(std::fabs(pass.friction) + std::fabs(pass.dashpot) + std::fabs(pass.broken));
}

void EnergyBalance::add_rows(const RowWork& work, double stored_in_contacts) {
  total_[body].add(work.body);
  total_[damping].add(-work.damping);
  total_[boundary].add(work.boundary);
  passed_.add(std::fabs(work.body) + std::fabs(work.damping) + std::fabs(work.boundary));
  most_stored_ = std::max(most_stored_, work.kinetic + stored_in_contacts);
}

void EnergyBalance::add_walls(double work) {
  total_[boundary].add(work);
  passed_.add(std::fabs(work));
}

// Stored energy less what came in, plus what was lost: constant if nothing is forgotten.
double EnergyBalance::balance(const StoredEnergy& now) const {
  const double in = total_[body].value() + now.before.body + total_[boundary].value() + now.before.boundary +
                    now.wall_before + total_[edits].value();
  const double lost = total_[friction].value() + total_[dashpot].value() + total_[broken].value() +
                      total_[damping].value() - now.before.damping;
  return now.kinetic_shadow + now.strain + now.bond - in + lost;
}

double EnergyBalance::residual(const StoredEnergy& now) const { return begun_ ? balance(now) - start_ : 0.0; }

double EnergyBalance::residual_share(const StoredEnergy& now) const {
  const double through = std::max(most_stored_, now.kinetic + now.strain + now.bond) + passed_.value();
  return through > 0 ? std::fabs(residual(now)) / through : 0.0;
}

void EnergyBalance::begin(const StoredEnergy& now) {
  start_ = balance(now);
  begun_ = true;
}

void EnergyBalance::before_edit(const StoredEnergy& now) {
  if (begun_ && !edited_) edited_ = residual(now);
}

void EnergyBalance::after_edit(const StoredEnergy& now) {
  if (edited_) total_[edits].add(residual(now) - *edited_);
  edited_.reset();
}

const std::vector<std::string>& EnergyBalance::terms() {
  static const std::vector<std::string> names = {"body",     "boundary", "kinetic", "kinetic_shadow", "strain", "bond",
                                                 "friction", "dashpot",  "damping", "bond_break",     "edits"};
  return names;
}

double EnergyBalance::value(const std::string& term, const StoredEnergy& now) const {
  if (term == "body") return total_[body].value() + now.before.body;
  if (term == "boundary") return total_[boundary].value() + now.before.boundary + now.wall_before;
  if (term == "kinetic") return now.kinetic;
  if (term == "kinetic_shadow") return now.kinetic_shadow;
  if (term == "strain") return now.strain;
  if (term == "bond") return now.bond;
  if (term == "friction") return total_[friction].value();
  if (term == "dashpot") return total_[dashpot].value();
  if (term == "damping") return total_[damping].value() - now.before.damping;
  if (term == "bond_break") return total_[broken].value();
  if (term == "edits") return total_[edits].value();
  return term == "residual" ? residual(now) : residual_share(now);
}

std::array<double, EnergyBalance::saved_words> EnergyBalance::save() const {
  std::array<double, saved_words> words{};
  std::size_t at = 0;
  for (const CarefulSum& sum : total_) {
    words[at++] = sum.sum;
    words[at++] = sum.rest;
  }
  for (double value : {passed_.sum, passed_.rest, most_stored_, start_, begun_ ? 1.0 : 0.0}) words[at++] = value;
  return words;
}

void EnergyBalance::load(const std::array<double, saved_words>& words) {
  std::size_t at = 0;
  for (CarefulSum& sum : total_) {
    sum.sum = words[at++];
    sum.rest = words[at++];
  }
  passed_.sum = words[at++];
  passed_.rest = words[at++];
  most_stored_ = words[at++];
  start_ = words[at++];
  begun_ = words[at] != 0;
  edited_.reset();
}

}  // namespace scree::core
