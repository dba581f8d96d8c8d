#pragma once
/// Everything a contact law needs. The author writes one struct for one contact:
///
///     struct Linear {
///       double kn, ks, fric;                                     // properties: double or Vec3
///       static void describe(Properties<Linear>& p);             // names, units, bounds, defaults
///       struct State { Vec3 shear; };                            // zero for a new contact, saved in checkpoints
///       void law(const Contact& c, State& s, Response& r) const; // any thread; reads only its arguments
///       Stiffness stiffness(const Contact& c) const;             // for the stable step
///     };
///     SCREE_CONTACT_MODEL(Linear, "linear", "1.0.0", "springs and friction")
///
/// `law` takes SpinContact to read spins and MomentResponse to return a moment. Optional members, all absent by default
/// and then neither stored nor called:
///
///     void prepare();                          // all inputs are in place; may throw to refuse them
///     void mixed(const L& piece1, const L& piece2);  // inputs from two pieces where no mix of single ones will do;
///                                              // what a wall does not give is NaN; may throw to refuse
///     void derive(const Pair& p);              // properties that follow from radii or masses
///     double reach(const Pair& p) const;       // gap up to which the law runs, m (0 without it)
///     void energy(const Contact&, const State& before, const State& after, const Response&, Energies&) const;
///     bool normal_only() const;                // this rule has no tangential part ...
///     void law_normal(const NormalContact&, NormalResponse&) const;   // ... and this is what is left
///     void energy_normal(const NormalContact&, const NormalResponse&, Energies&) const;
///     struct Bond { ... };                     // what a bonded contact remembers besides
///     void law(const Contact&, State&, Bond&, Response&) const;
///     double broken(const Bond&) const;        // 0 intact, 1 tension, 2 shear
///     Stiffness stiffness(const Contact&, const State&, const Bond&) const;
///     static constexpr bool nonlinear = true;  // the stiffness changes with the gap
///
/// A law runs on any thread and must be a pure function of what it is handed. It may use if, early return, sqrt and the
/// functions of math.hpp; std::pow and its like are slow and differ in the last bit from machine to machine.
#include <scree/abi.h>
#include <scree/contact_batch.hpp>
#include <scree/plugin.hpp>
#include <scree/refusal.hpp>

#include <limits>
#include <memory>

namespace scree {
namespace table {

template <class L>
L read_rule(const void* rule) {
  L out{};
  std::memcpy(static_cast<void*>(&out), rule, sizeof out);
  return out;
}

template <class L>
int prepare(double* rule, uint32_t form, const scree_refusal* refusal) {
  return guarded(refusal, [&] {
    L law = read_rule<L>(rule);
    if constexpr (shape::PreparesForm<L>)
      law.prepare(form);
    else
      law.prepare();
    std::memcpy(rule, &law, sizeof law);
  });
}
template <class L>
int mixed(double* rule, const double* piece1, const double* piece2, uint32_t, const scree_refusal* refusal) {
  return guarded(refusal, [&] {
    L law = read_rule<L>(rule);
    law.mixed(read_rule<L>(piece1), read_rule<L>(piece2));
    std::memcpy(rule, &law, sizeof law);
  });
}
template <class L>
void derive(double* rule, uint32_t form, const scree_pair* pair) {
  try {
    L law = read_rule<L>(rule);
    law.derive(Pair{pair->r1, pair->r2, pair->mass, form});
    std::memcpy(rule, &law, sizeof law);
  } catch (...) {
    // There is no way to say no here; what is not a number stops the run at its first contact.
    for (std::size_t k = 0; k < shape::words<L>(); ++k) rule[k] = std::numeric_limits<double>::quiet_NaN();
  }
}
template <class L>
double reach(const double* rule, const scree_pair* pair) {
  try {
    return read_rule<L>(rule).reach(Pair{pair->r1, pair->r2, pair->mass, 0});
  } catch (...) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}
template <class L>
uint32_t needs(const double* rule) {
  constexpr uint32_t all = shape::flags<L>();
  try {
    if (read_rule<L>(rule).normal_only()) return SCREE_NORMAL_ONLY | (all & SCREE_NONLINEAR);
  } catch (...) {
    return all;
  }
  return all;
}

inline double value(const double* column, std::size_t i) { return column != nullptr ? column[i] : 0.0; }
inline void store(double* column, std::size_t i, double v) {
  if (column != nullptr) column[i] = v;
}
/// A pair that does not touch yet has neither velocity nor state: absent columns read as zero.
inline SpinContact contact_of(const scree_batch& b, std::size_t i) {
  SpinContact c;
  c.normal = {value(b.nx, i), value(b.ny, i), value(b.nz, i)};
  c.gap = value(b.gap, i);
  c.dt = b.dt;
  c.mass = value(b.mass, i);
  c.r1 = value(b.r1, i);
  c.r2 = value(b.r2, i);
  c.set_velocity({value(b.vx, i), value(b.vy, i), value(b.vz, i)});
  c.spin = {value(b.wx, i), value(b.wy, i), value(b.wz, i)};
  c.set_turn({value(b.tx, i), value(b.ty, i), value(b.tz, i)});
  return c;
}
template <class L>
Stiffness stiffness_of(const L& law, const scree_batch& b, std::size_t i) {
  using State = shape::State<L>;
  const SpinContact c = contact_of(b, i);
  State state{};
  if (b.state != nullptr) state = batch::gather<State>(b.state, i, 0, batch::Indices<State>{});
  if constexpr (shape::StiffnessOfBond<L>) {
    using Bond = shape::Bond<L>;
    if (b.bonded != nullptr && b.bonded[i] != 0 && b.state != nullptr)
      return law.stiffness(c, state, batch::gather<Bond>(b.state, i, shape::words<State>(), batch::Indices<Bond>{}));
  }
  if constexpr (shape::StiffnessOfState<L>)
    return law.stiffness(c, state);
  else
    return law.stiffness(c);
}
template <class L>
void stiffness(const void* rule, const scree_batch* b, const scree_stiffness* out) {
  for (uint32_t i = 0; i < b->n; ++i) {
    Stiffness k;
    try {
      k = stiffness_of(
          b->property != nullptr ? batch::gather<L>(b->property, i, 0, batch::Indices<L>{}) : read_rule<L>(rule), *b,
          i);
    } catch (...) {
      k.normal = std::numeric_limits<double>::quiet_NaN();
    }
    store(out->normal, i, k.normal);
    store(out->shear, i, k.shear);
    store(out->bending, i, k.bending);
    store(out->twist, i, k.twist);
    store(out->dashpot_normal, i, k.dashpot);
    store(out->dashpot_shear, i, k.dashpot_shear);
  }
}

/// The table of one model and the memory its pointers lead to.
template <class L>
class ModelTable {
 public:
  ModelTable() {
    L::describe(properties_);
    properties_.finish();
    states_ = properties_.states();
    constexpr uint32_t all_words =
        static_cast<uint32_t>(shape::words<shape::State<L>>() + shape::words<shape::Bond<L>>());
    if (states_.empty() && all_words > 0) states_.push_back({"state", "1", 0, all_words});
    fill();
    fill_laws();
  }
  const scree_contact_model* get() const { return &table_; }

 private:
  void fill() {
    table_.struct_size = sizeof table_;
    table_.flags = shape::flags<L>();
    table_.property_count = static_cast<uint32_t>(properties_.rows().size());
    table_.properties = properties_.rows().data();
    table_.state_count = static_cast<uint32_t>(states_.size());
    table_.states = states_.data();
    table_.rule_words = shape::words<L>();
    table_.state_words = shape::words<shape::State<L>>();
    table_.bond_words = shape::words<shape::Bond<L>>();
    table_.form_count = static_cast<uint32_t>(properties_.forms().size());
    table_.forms = properties_.forms().empty() ? nullptr : properties_.forms().data();
    if constexpr (shape::Prepares<L>) table_.prepare = prepare<L>;
    if constexpr (shape::Derives<L>) {
      table_.derive = derive<L>;
      table_.derived_from_pair = properties_.pair_forms();
    }
    if constexpr (shape::Mixes<L>) table_.mixed = mixed<L>;
    if constexpr (shape::Reaches<L>) table_.reach = reach<L>;
    if constexpr (shape::KnowsNormalOnly<L>) table_.needs = needs<L>;
    table_.stiffness = stiffness<L>;
  }
  void fill_laws() {
    int k = 0;
#define SCREE_ENTRY(isa, attributes)                                                    \
  table_.uniform[k] = batch::touch_##isa<L, false, false>;                              \
  table_.varying[k] = batch::touch_##isa<L, true, false>;                               \
  if constexpr (shape::HasEnergy<L>) {                                                  \
    table_.uniform_energy[k] = batch::touch_##isa<L, false, true>;                      \
    table_.varying_energy[k] = batch::touch_##isa<L, true, true>;                       \
  }                                                                                     \
  if constexpr (shape::HasBond<L>) {                                                    \
    table_.bonded[k] = batch::bonded_##isa<L, false>;                                   \
    table_.bonded_varying[k] = batch::bonded_##isa<L, true>;                            \
  }                                                                                     \
  if constexpr (shape::HasLawNormal<L>) table_.normal_only[k] = batch::normal_##isa<L>; \
  ++k;
    SCREE_TARGETS(SCREE_ENTRY)
#undef SCREE_ENTRY
  }

  Properties<L> properties_;
  std::vector<scree_state_word> states_;
  scree_contact_model table_{};
};

/// Null when `describe` threw; the host then refuses the library.
template <class L>
const void* model_table() {
  try {
    static const ModelTable<L> model;
    return model.get();
  } catch (...) {
    return nullptr;
  }
}

}  // namespace table

/// One entry for SCREE_PLUGIN. All texts are string literals.
template <class L>
constexpr scree_component contact_model(const char* name, const char* version, const char* doc = "") {
  if constexpr (shape::valid<L>())
    return {SCREE_CONTACT_MODEL, 0, name, version, doc, table::model_table<L>};
  else
    return {};
}

}  // namespace scree

/// A library that holds one contact model: SCREE_CONTACT_MODEL(Linear, "linear", "1.0.0", "springs and friction").
#define SCREE_CONTACT_MODEL(Model, ...) SCREE_PLUGIN(scree::contact_model<Model>(__VA_ARGS__))
