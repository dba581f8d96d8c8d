#include "core/vet/law_bench.hpp"

#include <algorithm>
#include <cstring>

#include "core/base/log.hpp"
#include "core/vet/outcome.hpp"

namespace scree::core::vet {

namespace {

constexpr double guard_value = -6.27e66;  // a number that no law writes

std::string text_of(const Vec3& v) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", v.x, v.y, v.z); }

uint64_t bits_of(double value) {
  uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

}  // namespace

std::string text_of(const Seen& s) {
  return fmt::format(
      "gap {:.6g} m, normal {}, velocity {} m/s, spin {} rad/s, turn {}, radii {:.4g} and {:.4g} m, mass "
      "{:.4g} kg",
      s.gap, text_of(s.normal), text_of(s.velocity), text_of(s.spin), text_of(s.turn), s.r1, s.r2, s.mass);
}

const char* part_name(Part part) {
  return part == Part::bonded ? "bonded" : part == Part::touch ? "touching" : "without tangential part";
}

LawBench::LawBench(const scree_contact_model& model, Part part, std::size_t count, const std::vector<double>& words)
    : reach(count, 0.0), model_(model), part_(part), count_(count), rule_(words) {
  for (auto& c : in_) c = column();
  for (auto& c : out_) c = column();
  for (auto& c : energy_) c = column();
  state_.assign(part == Part::normal_only ? 0 : model.state_words + (part == Part::bonded ? model.bond_words : 0),
                column());
  words_.assign(rule_.size(), column());
  for (std::size_t i = 0; i < count_; ++i) {
    set_words(i, rule_);
    put(i, Seen{});
  }
  mask_.assign(count_, 1);
}

LawBench::Column LawBench::column() const {
  Column c(count_ + 2 * guard, guard_value);
  std::fill_n(c.begin() + guard, count_, 0.0);
  return c;
}

void LawBench::put(std::size_t i, const Seen& s) {
  const double values[] = {s.normal.x,   s.normal.y, s.normal.z, s.gap,    s.velocity.x, s.velocity.y,
                           s.velocity.z, s.spin.x,   s.spin.y,   s.spin.z, s.turn.x,     s.turn.y,
                           s.turn.z,     s.r1,       s.r2,       s.mass};
  for (std::size_t k = 0; k < in_.size(); ++k) in_[k][guard + i] = values[k];
}

void LawBench::set_words(std::size_t i, const std::vector<double>& words) {
  for (std::size_t w = 0; w < words_.size(); ++w) words_[w][guard + i] = words[w];
}

scree_law LawBench::law() const {
  if (part_ == Part::normal_only) return pick(model_.normal_only, isa);
  if (part_ == Part::bonded) return varying ? pick(model_.bonded_varying, isa) : pick(model_.bonded, isa);
  if (energy) return varying ? pick(model_.varying_energy, isa) : pick(model_.uniform_energy, isa);
  return varying ? pick(model_.varying, isa) : pick(model_.uniform, isa);
}

scree_batch LawBench::prepared(std::size_t first, std::size_t count) {
  const std::size_t at = guard + first;
  scree_batch b{};
  b.struct_size = sizeof b;
  b.n = static_cast<uint32_t>(count);
  b.dt = dt;
  const double** const in[] = {&b.nx, &b.ny, &b.nz, &b.gap, &b.vx, &b.vy, &b.vz, &b.wx,
                               &b.wy, &b.wz, &b.tx, &b.ty,  &b.tz, &b.r1, &b.r2, &b.mass};
  for (std::size_t k = 0; k < in_.size(); ++k) *in[k] = in_[k].data() + at;
  double** const out[] = {&b.fx, &b.fy, &b.fz, &b.mx, &b.my, &b.mz, &b.event, &b.sliding};
  for (std::size_t k = 0; k < out_.size(); ++k) *out[k] = out_[k].data() + at;
  const bool plain = part_ == Part::normal_only;
  if (plain || (model_.flags & SCREE_NEEDS_SPIN) == 0) b.wx = b.wy = b.wz = nullptr;
  if (plain || (model_.flags & SCREE_NEEDS_TURN) == 0) b.tx = b.ty = b.tz = nullptr;
  if (plain || (model_.flags & SCREE_GIVES_MOMENT) == 0) b.mx = b.my = b.mz = nullptr;
  if (part_ != Part::bonded) b.event = nullptr;
  if (part_ == Part::bonded) b.bonded = mask_.data() + first;
  property_pointers_.clear();
  for (auto& c : words_) property_pointers_.push_back(c.data() + at);
  state_pointers_.clear();
  for (auto& c : state_) state_pointers_.push_back(c.data() + at);
  for (std::size_t k = 0; k < 4; ++k) energy_pointers_[k] = energy_[k].data() + at;
  if (varying) b.property = property_pointers_.data();
  if (!plain) b.state = state_pointers_.data();
  if (energy) b.energy = energy_pointers_.data();
  return b;
}

void LawBench::run() {
  copy_ = in_;
  const scree_law function = law();
  for (std::size_t first = 0; first < count_; first += batch) {
    const scree_batch b = prepared(first, std::min(batch, count_ - first));
    if (function(rule_.data(), &b) == UINT32_MAX)
      throw Failed("the law threw an exception while it ran",
                   "a law answers for every input; refuse inputs in 'prepare'");
  }
  drop_open();
}

void LawBench::drop_open() {
  if (part_ == Part::bonded) return;
  for (std::size_t i = 0; i < count_; ++i) {
    if (!(in_[3][guard + i] >= reach[i])) continue;
    for (auto& c : out_) c[guard + i] = 0;
    for (auto& c : energy_) c[guard + i] = 0;
    for (auto& c : state_) c[guard + i] = 0;
  }
}

Tangent LawBench::tangent(std::size_t i) {
  Tangent t;
  scree_batch b = prepared(i, 1);
  b.dt = 0;
  const scree_stiffness out{sizeof(scree_stiffness), 1, &t.normal, &t.shear, &t.bending, &t.twist, &t.dashpot_normal,
                            &t.dashpot_shear};
  model_.stiffness(rule_.data(), &b, &out);
  return t;
}

void LawBench::copy_state(std::size_t i, const LawBench& from, std::size_t j) {
  for (std::size_t w = 0; w < state_.size(); ++w) set_state(w, i, from.state(w, j));
}

void LawBench::mark_energies() {
  for (Column& c : energy_) std::fill(c.begin(), c.end(), guard_value);
}

bool LawBench::energies_written() const { return energy_[0][guard] != guard_value; }

std::vector<uint64_t> LawBench::bits() const {
  std::vector<uint64_t> all;
  for (std::size_t i = 0; i < count_; ++i) {
    for (const Column& c : out_) all.push_back(bits_of(c[guard + i]));
    for (const Column& c : state_) all.push_back(bits_of(c[guard + i]));
  }
  return all;
}

bool LawBench::guarded(const Column& c) const {
  const auto whole = [](double value) { return value == guard_value; };
  return std::all_of(c.begin(), c.begin() + guard, whole) && std::all_of(c.end() - guard, c.end(), whole);
}

std::string LawBench::trespass() const {
  const char* const outputs[] = {"fx", "fy", "fz", "mx", "my", "mz", "event", "sliding"};
  for (std::size_t k = 0; k < out_.size(); ++k)
    if (!guarded(out_[k])) return fmt::format("words beside the array '{}' were written", outputs[k]);
  for (std::size_t k = 0; k < state_.size(); ++k)
    if (!guarded(state_[k])) return fmt::format("words beside word {} of the state were written", k);
  for (const Column& c : energy_)
    if (!guarded(c)) return "words beside the energies were written";
  for (std::size_t k = 0; k < in_.size(); ++k)
    if (std::memcmp(in_[k].data(), copy_[k].data(), in_[k].size() * sizeof(double)) != 0)
      return "an array that the law may only read was written";
  return "";
}

}  // namespace scree::core::vet
