#pragma once
// Contacts in the columns that a law sees, with values chosen by a test.
#include <scree/abi.h>
#include <scree/math.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/base/isa.hpp"
#include "core/plugin/catalogue.hpp"

namespace scree::test {

/// SplitMix64 (Steele, Lea and Flood 2014): the same numbers on every machine.
class Numbers {
 public:
  explicit Numbers(uint64_t seed) : state_(seed) {}
  uint64_t bits() {
    uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1.0p-53);
  }
  Vec3 vector(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }

 private:
  uint64_t state_;
};

/// One contact as a test thinks of it.
struct OneContact {
  Vec3 normal{0, 0, 1}, velocity, spin, turn;
  double gap = 0, r1 = 0.01, r2 = 0.01, mass = 0.01;
};

/// Overlapping by up to 0.1 mm or open by up to `most_gap`, in any motion of up to 1 m/s and `most_spin` (rad/s).
inline OneContact random_contact(Numbers& random, double most_gap, double most_spin) {
  OneContact c;
  c.normal = random.vector(1).normalized();
  c.gap = random.between(-1e-4, most_gap);
  c.velocity = random.vector(1);
  c.spin = random.vector(most_spin);
  c.turn = random.vector(1e-3);
  return c;
}

/// Contacts under one rule, with their state, in the memory layout of the boundary.
class Columns {
 public:
  Columns(const scree_contact_model& model, std::vector<double> rule, std::size_t n)
      : model_(model),
        rule_(std::move(rule)),
        n_(n),
        words_(rule_.size()),
        state_(model.state_words + model.bond_words) {
    for (auto& column : in_) column.assign(n, 0.0);
    for (auto& column : out_) column.assign(n, 0.0);
    for (auto& column : energy_) column.assign(n, 0.0);
    for (auto& column : state_) column.assign(n, 0.0);
    bonded_mask_.assign(n, 1);
    for (std::size_t w = 0; w < rule_.size(); ++w) words_[w].assign(n, rule_[w]);
  }

  void put(std::size_t i, const OneContact& c) {
    const double values[] = {c.normal.x,   c.normal.y, c.normal.z, c.gap,    c.velocity.x, c.velocity.y,
                             c.velocity.z, c.spin.x,   c.spin.y,   c.spin.z, c.turn.x,     c.turn.y,
                             c.turn.z,     c.r1,       c.r2,       c.mass};
    for (std::size_t k = 0; k < in_.size(); ++k) in_[k][i] = values[k];
  }
  void set_rule(std::size_t word, double value) {
    rule_[word] = value;
    words_[word].assign(n_, value);
  }

  double dt = 1e-5;
  bool varying = false, energy = false, normal_only = false, bonded = false;

  /// Runs the law over all contacts in batches of at most `size`.
  uint32_t run(core::Isa isa = core::Isa::baseline, std::size_t size = SCREE_BATCH) {
    const auto& table = normal_only         ? model_.normal_only
                        : bonded && varying ? model_.bonded_varying
                        : bonded            ? model_.bonded
                        : varying && energy ? model_.varying_energy
                        : varying           ? model_.varying
                        : energy            ? model_.uniform_energy
                                            : model_.uniform;
    const scree_law law = core::pick(table, isa);
    uint32_t breaks = 0;
    for (std::size_t first = 0; first < n_; first += size) {
      const scree_batch b = batch(first, std::min(size, n_ - first));
      breaks += law(rule_.data(), &b);
    }
    return breaks;
  }
  void stiffness(const scree_stiffness& out) {
    const scree_batch b = batch(0, n_);
    model_.stiffness(rule_.data(), &b, &out);
  }

  Vec3 force(std::size_t i) const { return {out_[0][i], out_[1][i], out_[2][i]}; }
  Vec3 moment(std::size_t i) const { return {out_[3][i], out_[4][i], out_[5][i]}; }
  double event(std::size_t i) const { return out_[6][i]; }
  bool sliding(std::size_t i) const { return out_[7][i] != 0; }
  double energies(std::size_t term, std::size_t i) const { return energy_[term][i]; }
  std::vector<double>& state(std::size_t word) { return state_[word]; }
  std::size_t size() const { return n_; }

  /// FNV-1a over the bits of forces, sliding flags and state.
  uint64_t hash() const {
    uint64_t h = 0xcbf29ce484222325u;
    const auto add = [&](const std::vector<double>& column) {
      for (const double value : column) {
        uint64_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        for (int k = 0; k < 8; ++k) h = (h ^ ((bits >> (8 * k)) & 0xff)) * 0x100000001b3u;
      }
    };
    for (const auto& column : out_) add(column);
    for (const auto& column : state_) add(column);
    return h;
  }

 private:
  scree_batch batch(std::size_t first, std::size_t count) {
    scree_batch b{};
    b.struct_size = sizeof b;
    b.n = static_cast<uint32_t>(count);
    b.dt = dt;
    const double** const in[] = {&b.nx, &b.ny, &b.nz, &b.gap, &b.vx, &b.vy, &b.vz, &b.wx,
                                 &b.wy, &b.wz, &b.tx, &b.ty,  &b.tz, &b.r1, &b.r2, &b.mass};
    for (std::size_t k = 0; k < in_.size(); ++k) *in[k] = in_[k].data() + first;
    if (normal_only) b.wx = b.wy = b.wz = b.tx = b.ty = b.tz = b.r1 = b.r2 = nullptr;
    double** const out[] = {&b.fx, &b.fy, &b.fz, &b.mx, &b.my, &b.mz, &b.event, &b.sliding};
    for (std::size_t k = 0; k < out_.size(); ++k) *out[k] = out_[k].data() + first;
    property_.clear();
    for (auto& column : words_) property_.push_back(column.data() + first);
    memory_.clear();
    for (auto& column : state_) memory_.push_back(column.data() + first);
    for (std::size_t k = 0; k < 4; ++k) energy_pointer_[k] = energy_[k].data() + first;
    if (bonded) b.bonded = bonded_mask_.data() + first;
    if (varying) b.property = property_.data();
    if (!normal_only) b.state = memory_.data();
    if (energy) b.energy = energy_pointer_.data();
    return b;
  }

  const scree_contact_model& model_;
  std::vector<double> rule_;
  std::size_t n_;
  std::array<std::vector<double>, 16> in_;
  std::array<std::vector<double>, 8> out_;
  std::array<std::vector<double>, 4> energy_;
  std::vector<std::vector<double>> words_, state_;
  std::vector<const double*> property_;
  std::vector<double*> memory_;
  std::array<double*, 4> energy_pointer_{};
  std::vector<uint8_t> bonded_mask_;
};

/// The plug-ins of this build only, whatever else is installed for the user.
inline core::Catalogue& built_plugins() {
  static core::Catalogue catalogue(core::SearchPath{{}, {core::SearchPath::standard({}).others.back()}});
  return catalogue;
}
inline std::size_t word_of(const scree_contact_model& model, const std::string& name) {
  for (uint32_t k = 0; k < model.property_count; ++k)
    if (name == model.properties[k].name) return model.properties[k].word;
  throw std::runtime_error("no property " + name);
}
using Settings = std::vector<std::pair<std::string, double>>;
/// The rule's struct with fallbacks, then with `settings`.
inline std::vector<double> rule_of(const scree_contact_model& model, const Settings& settings) {
  std::vector<double> rule(model.rule_words, 0.0);
  for (uint32_t k = 0; k < model.property_count; ++k)
    if ((model.properties[k].flags & SCREE_HAS_FALLBACK) != 0)
      rule[model.properties[k].word] = model.properties[k].fallback;
  for (const auto& [name, value] : settings) rule[word_of(model, name)] = value;
  return rule;
}

}  // namespace scree::test
