#pragma once
/// What a contact model must look like, checked while it is compiled: one sentence per mistake.
#include <scree/contact.hpp>
#include <scree/properties.hpp>

#include <concepts>
#include <type_traits>
#include <utility>

namespace scree::shape {

/// Converts to exactly double. Brace elision carries it into Vec3 and into arrays, so `T{any, any, ...}` with one entry
/// per eight bytes compiles only if every word of T is a double.
struct AnyDouble {
  template <std::same_as<double> D>
  operator D() const;
};
/// Fills a double or a whole Vec3, so fewer of these than words fit into a struct that holds a Vec3.
struct AnyMember {
  template <class M>
  requires std::same_as<M, double> || std::same_as<M, Vec3>
  operator M() const;
};

template <class Entry, class T, std::size_t... K>
consteval bool takes(std::index_sequence<K...>) {
  return requires { T{((void)K, Entry{})...}; };
}
template <class T>
consteval std::size_t words() {
  return std::is_empty_v<T> ? 0 : sizeof(T) / sizeof(double);
}
template <class T>
consteval bool plain() {
  if constexpr (std::is_empty_v<T>)
    return std::is_trivially_copyable_v<T>;
  else if constexpr (!std::is_aggregate_v<T> || !std::is_trivially_copyable_v<T> || sizeof(T) % sizeof(double) != 0)
    return false;
  else
    return takes<AnyDouble, T>(std::make_index_sequence<words<T>()>{});
}
template <class T>
consteval bool holds_vector() {
  if constexpr (std::is_empty_v<T>)
    return false;
  else
    return !takes<AnyMember, T>(std::make_index_sequence<words<T>()>{});
}

/// Stands in for a State or Bond that the author left out.
struct Nothing {};
template <class L>
consteval auto state_of() {
  if constexpr (requires { typename L::State; })
    return std::type_identity<typename L::State>{};
  else
    return std::type_identity<Nothing>{};
}
template <class L>
consteval auto bond_of() {
  if constexpr (requires { typename L::Bond; })
    return std::type_identity<typename L::Bond>{};
  else
    return std::type_identity<Nothing>{};
}
template <class L>
using State = typename decltype(state_of<L>())::type;
template <class L>
using Bond = typename decltype(bond_of<L>())::type;
template <class L>
concept HasState = requires {
  typename L::State;
};
template <class L>
concept HasBond = requires {
  typename L::Bond;
};

template <class L, class C, class R>
concept TouchLaw = requires(const L& l, const C& c, State<L>& s, R& r) {
  l.law(c, s, r);
}
|| (!HasState<L> && requires(const L& l, const C& c, R& r) { l.law(c, r); });
template <class L, class C, class R>
concept BondLaw = requires(const L& l, const C& c, State<L>& s, Bond<L>& b, R& r) {
  l.law(c, s, b, r);
};
template <class L>
concept AnyTouchLaw = TouchLaw<L, SpinContact, MomentResponse>;
template <class L>
concept AnyBondLaw = HasBond<L> && BondLaw<L, SpinContact, MomentResponse>;
// A law that takes the plain types also accepts the richer ones: it needs the richer only if the plain do not do.
template <class L>
concept ReadsSpin = (AnyTouchLaw<L> && !TouchLaw<L, Contact, MomentResponse>) ||
                    (AnyBondLaw<L> && !BondLaw<L, Contact, MomentResponse>);
template <class L>
concept GivesMoment = (AnyTouchLaw<L> && !TouchLaw<L, SpinContact, Response>) ||
                      (AnyBondLaw<L> && !BondLaw<L, SpinContact, Response>);

template <class L>
concept StiffnessOfState = requires(const L& l, const Contact& c, const State<L>& s) {
  { l.stiffness(c, s) } -> std::same_as<Stiffness>;
};
template <class L>
concept StiffnessOfContact = requires(const L& l, const Contact& c) {
  { l.stiffness(c) } -> std::same_as<Stiffness>;
};
template <class L>
concept StiffnessOfBond = requires(const L& l, const Contact& c, const State<L>& s, const Bond<L>& b) {
  { l.stiffness(c, s, b) } -> std::same_as<Stiffness>;
};

// Optional members: the name is looked for apart from the signature, so a wrong signature is never ignored silently. A
// property of the same name is data and does not count.
#define SCREE_NAMES(Concept, member)                                  \
  template <class L>                                                  \
  concept Concept = requires {                                        \
    requires std::is_member_function_pointer_v<decltype(&L::member)>; \
  }
SCREE_NAMES(NamesBroken, broken);
SCREE_NAMES(NamesReach, reach);
SCREE_NAMES(NamesPrepare, prepare);
SCREE_NAMES(NamesDerive, derive);
SCREE_NAMES(NamesMixed, mixed);
SCREE_NAMES(NamesEnergy, energy);
SCREE_NAMES(NamesNormalOnly, normal_only);
SCREE_NAMES(NamesLawNormal, law_normal);
#undef SCREE_NAMES

template <class L>
concept Breaks = HasBond<L> && requires(const L& l, const Bond<L>& b) {
  { l.broken(b) } -> std::same_as<double>;
};
template <class L>
concept Reaches = requires(const L& l, const Pair& p) {
  { l.reach(p) } -> std::same_as<double>;
};
template <class L>
concept PreparesForm = requires(L& l, uint32_t form) {
  l.prepare(form);
};
template <class L>
concept Prepares = PreparesForm<L> || requires(L& l) {
  l.prepare();
};
template <class L>
concept Derives = requires(L& l, const Pair& p) {
  l.derive(p);
};
template <class L>
concept Mixes = requires(L& l, const L& piece) {
  l.mixed(piece, piece);
};
template <class L>
concept HasEnergy = requires(const L& l, const SpinContact& c, const State<L>& s, const MomentResponse& r,
                             Energies& e) {
  l.energy(c, s, s, r, e);
};
template <class L>
concept HasBondEnergy = HasBond<L> && requires(const L& l, const SpinContact& c, const State<L>& s, const Bond<L>& b,
                                               const MomentResponse& r, Energies& e) {
  l.energy(c, s, s, b, b, r, e);
};
template <class L>
concept KnowsNormalOnly = requires(const L& l) {
  { l.normal_only() } -> std::same_as<bool>;
};
template <class L>
concept HasLawNormal = requires(const L& l, const NormalContact& c, NormalResponse& r) {
  l.law_normal(c, r);
};
template <class L>
concept HasNormalEnergy = requires(const L& l, const NormalContact& c, const NormalResponse& r, Energies& e) {
  l.energy_normal(c, r, e);
};

#define SCREE_REFUSE(sentence)               \
  do {                                       \
    static_assert(sizeof(L) == 0, sentence); \
    return false;                            \
  } while (false)

/// The rest of the adapter is compiled only for a model that passes, so that a mistake gives one error.
template <class L>
consteval bool valid_members() {
  if constexpr (NamesBroken<L> && !Breaks<L>)
    SCREE_REFUSE("scree: 'broken' must be 'double broken(const Bond&) const' (0 intact, 1 tension, 2 shear)");
  else if constexpr (NamesReach<L> && !Reaches<L>)
    SCREE_REFUSE("scree: 'reach' must be 'double reach(const Pair&) const' (the gap up to which the law runs, m)");
  else if constexpr (NamesPrepare<L> && !Prepares<L>)
    SCREE_REFUSE("scree: 'prepare' must be 'void prepare()' or 'void prepare(uint32_t form)', not const");
  else if constexpr (NamesDerive<L> && !Derives<L>)
    SCREE_REFUSE("scree: 'derive' must be 'void derive(const Pair&)', not const");
  else if constexpr (NamesMixed<L> && !Mixes<L>)
    SCREE_REFUSE("scree: 'mixed' must be 'void mixed(const L& piece1, const L& piece2)', not const");
  else if constexpr (NamesEnergy<L> && !HasEnergy<L> && !HasBondEnergy<L>)
    SCREE_REFUSE(
        "scree: 'energy' must be 'void energy(const Contact&, const State& before, const State& after, const "
        "Response&, Energies&) const'");
  else if constexpr ((NamesNormalOnly<L> || NamesLawNormal<L>)&&!(KnowsNormalOnly<L> && HasLawNormal<L>))
    SCREE_REFUSE(
        "scree: a model that can do without shear has both 'bool normal_only() const' and 'void law_normal(const "
        "NormalContact&, NormalResponse&) const'");
  else
    return true;
}

template <class L>
consteval bool valid() {
  if constexpr (!plain<L>() || std::is_empty_v<L>)
    SCREE_REFUSE(
        "scree: a contact model is a plain struct whose members are double or Vec3 and public, because the kernel may "
        "store one value per contact");
  else if constexpr (!plain<State<L>>())
    SCREE_REFUSE(
        "scree: State is a plain struct whose members are double, Vec3 or arrays of double, because it is saved in "
        "checkpoints");
  else if constexpr (!plain<Bond<L>>())
    SCREE_REFUSE(
        "scree: Bond is a plain struct whose members are double, Vec3 or arrays of double, because it is saved in "
        "checkpoints");
  else if constexpr (!requires(Properties<L> & p) { L::describe(p); })
    SCREE_REFUSE("scree: a contact model needs 'static void describe(Properties<L>&)', which names what a scene sets");
  else if constexpr (!AnyTouchLaw<L>)
    SCREE_REFUSE(
        "scree: a contact model needs 'void law(const Contact&, State&, Response&) const' (SpinContact to read spins, "
        "MomentResponse to return a moment)");
  else if constexpr (HasBond<L> && !AnyBondLaw<L>)
    SCREE_REFUSE(
        "scree: a contact model with a Bond needs 'void law(const Contact&, State&, Bond&, Response&) const' "
        "(SpinContact to read spins, MomentResponse to return a moment)");
  else if constexpr (!StiffnessOfState<L> && !StiffnessOfContact<L>)
    SCREE_REFUSE(
        "scree: a contact model needs 'Stiffness stiffness(const Contact&) const', because the stable step is computed "
        "from it");
  else
    return valid_members<L>();
}
#undef SCREE_REFUSE

/// The law keeps a direction from cycle to cycle, so the kernel must hand over how the contact turned.
template <class L>
consteval bool turns() {
  if constexpr (requires {
                  { L::turns } -> std::convertible_to<bool>;
                })
    return L::turns;
  else
    return holds_vector<State<L>>() || holds_vector<Bond<L>>();
}
template <class L>
consteval uint32_t flags() {
  uint32_t bits = 0;
  if (ReadsSpin<L>) bits |= SCREE_NEEDS_SPIN;
  if (turns<L>()) bits |= SCREE_NEEDS_TURN;
  if (GivesMoment<L>) bits |= SCREE_GIVES_MOMENT;
  if (HasBond<L>) bits |= SCREE_CAN_BOND;
  if constexpr (requires {
                  { L::nonlinear } -> std::convertible_to<bool>;
                })
    if (L::nonlinear) bits |= SCREE_NONLINEAR;
  return bits;
}

}  // namespace scree::shape
