#pragma once
/// The properties of a contact model: what a scene may set, tied to members of the author's struct.
///
///     static void describe(Properties<Linear>& p) {
///       p.number("kn", &Linear::kn, "N/m", "normal stiffness").at_least(0).mix(series);
///       p.number("fric", &Linear::fric, "1", "friction coefficient").at_least(0).fallback(0).mix(least);
///       p.remembers("shear", &Linear::State::shear, "N");
///     }
///
/// Every text is a string literal and every unit is in UDUNITS spelling ("1" for a pure number). A property without a
/// fallback must be given by the scene. Properties reach the law in SI.
#include <scree/abi.h>
#include <scree/math.hpp>

#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <vector>

namespace scree {

/// How the value of a pair follows from those of its two pieces, where the rule itself gives none.
enum Mix : uint32_t {
  series = SCREE_MIX_SERIES,     ///< a b / (a + b): springs in a row
  least = SCREE_MIX_LEAST,       ///< the smaller one
  mean = SCREE_MIX_MEAN,         ///< (a + b) / 2
  harmonic = SCREE_MIX_HARMONIC  ///< 2 a b / (a + b)
};

/// Refines one property; what every function that declares one returns.
class Property {
 public:
  Property(scree_property& row, std::vector<const char*>& pair_forms) : row_(row), pair_forms_(pair_forms) {}

  Property& at_least(double low) { return set_low(low, 0); }  ///< bounds are in SI units and checked before the law
  Property& above(double low) { return set_low(low, SCREE_LOW_OPEN); }  ///< the bound itself is not legal
  Property& at_most(double high) { return set_high(high, 0); }
  Property& below(double high) { return set_high(high, SCREE_HIGH_OPEN); }  ///< the bound itself is not legal
  /// The value where the scene is silent; without it the scene must give one.
  Property& fallback(double value) {
    row_.fallback = value;
    row_.flags = (row_.flags & ~static_cast<uint32_t>(SCREE_REQUIRED)) | SCREE_HAS_FALLBACK;
    return *this;
  }
  /// The pair's value from those of its pieces. Without it only the rule may give the property.
  Property& mix(Mix how) {
    row_.mix = how;
    return *this;
  }
  /// `.inf` is a legal value.
  Property& infinite() { return flag(SCREE_POSITIVE_INFINITY); }
  /// Never an input: `prepare` or `derive` computes it.
  Property& derived() {
    row_.flags &= ~static_cast<uint32_t>(SCREE_REQUIRED);
    return flag(SCREE_DERIVED);
  }
  /// An input in the other forms; in this one `derive` computes it from the pair. `form` is spelt as in `either`.
  Property& derived(const char* form) {
    pair_forms_.push_back(form);
    return *this;
  }

 private:
  Property& flag(uint32_t flags) {
    row_.flags |= flags;
    return *this;
  }
  Property& set_low(double low, uint32_t open) {
    row_.low = low;
    return flag(SCREE_HAS_LOW | open);
  }
  Property& set_high(double high, uint32_t open) {
    row_.high = high;
    return flag(SCREE_HAS_HIGH | open);
  }

  scree_property& row_;
  std::vector<const char*>& pair_forms_;
};

/// Collects the properties, the alternative inputs and the names of what a contact remembers. Filled once per library.
/// [one thread]
template <class L>
class Properties {
 public:
  /// Room for every property: references to rows stay valid while `describe` runs.
  Properties() { rows_.reserve(sizeof(L) / sizeof(double) + 1); }

  /// A real number.
  Property number(const char* name, double L::*member, const char* unit, const char* doc) {
    return add(SCREE_NUMBER, name, member, unit, doc);
  }
  /// A whole number, as a choice between numbered modes. The member is a double that holds an integer.
  Property integer(const char* name, double L::*member, const char* doc) {
    return add(SCREE_INTEGER, name, member, "1", doc);
  }
  /// true or false in a scene, 1 or 0 in the member.
  Property boolean(const char* name, double L::*member, const char* doc) {
    return add(SCREE_BOOLEAN, name, member, "1", doc);
  }
  /// Three numbers in the scene's frame.
  Property vector(const char* name, Vec3 L::*member, const char* unit, const char* doc) {
    return add(SCREE_VECTOR, name, member, unit, doc);
  }

  /// Alternative inputs: each text lists the properties of one form, separated by a space. A scene uses one form; a
  /// property that no form names is always allowed. Form 0 is the first.
  template <class... Forms>
  void either(Forms... forms) {
    (forms_.push_back(forms), ...);
  }

  /// Names a member of State or Bond, for checkpoints and pictures. Without it the words are saved as one block.
  template <class S, class M>
  void remembers(const char* name, M S::*member, const char* unit) {
    uint32_t word = place<S>(member);
    if constexpr (requires { typename L::Bond; })
      if constexpr (std::is_same_v<S, typename L::Bond>) word += static_cast<uint32_t>(state_words());
    states_.push_back({name, unit, word, static_cast<uint32_t>(sizeof(M) / sizeof(double))});
  }

  /// For the adapter: binds properties to forms and hands out the finished tables.
  void finish() {
    for (uint32_t form = 0; form < forms_.size(); ++form)
      for (scree_property& row : rows_)
        if (lists(forms_[form], row.name)) row.forms |= 1u << form;
  }
  /// Bit k: in form k `derive` reads the pair.
  uint32_t pair_forms() const {
    if (pair_forms_.empty()) return forms_.empty() ? 1u : (1u << forms_.size()) - 1u;
    uint32_t bits = 0;
    for (uint32_t form = 0; form < forms_.size(); ++form)
      for (const char* named : pair_forms_)
        if (std::string_view(named) == forms_[form]) bits |= 1u << form;
    return bits;
  }
  const std::vector<scree_property>& rows() const { return rows_; }
  const std::vector<const char*>& forms() const { return forms_; }
  const std::vector<scree_state_word>& states() const { return states_; }

 private:
  static constexpr std::size_t state_words() {
    if constexpr (requires { typename L::State; })
      return std::is_empty_v<typename L::State> ? 0 : sizeof(typename L::State) / sizeof(double);
    else
      return 0;
  }
  template <class S, class M>
  static uint32_t place(M S::*member) {
    S probe{};
    const char* begin = reinterpret_cast<const char*>(&probe);
    return static_cast<uint32_t>(static_cast<std::size_t>(reinterpret_cast<const char*>(&(probe.*member)) - begin) /
                                 sizeof(double));
  }
  /// Whole words only: "kn" is not in "pb_kn ks".
  static bool lists(std::string_view form, std::string_view name) {
    while (!form.empty()) {
      const std::size_t end = form.find(' ');
      if (form.substr(0, end) == name) return true;
      if (end == std::string_view::npos) return false;
      form.remove_prefix(end + 1);
    }
    return false;
  }
  template <class M>
  Property add(uint32_t type, const char* name, M L::*member, const char* unit, const char* doc) {
    if (rows_.size() == rows_.capacity()) throw "more properties than members";
    scree_property row{};
    row.struct_size = sizeof(scree_property);
    row.type = type;
    row.name = name;
    row.unit = unit;
    row.doc = doc;
    row.word = place<L>(member);
    row.words = static_cast<uint32_t>(sizeof(M) / sizeof(double));
    row.flags = SCREE_REQUIRED;
    row.mix = SCREE_MIX_NONE;
    rows_.push_back(row);
    return Property(rows_.back(), pair_forms_);
  }

  std::vector<scree_property> rows_;
  std::vector<const char*> forms_, pair_forms_;
  std::vector<scree_state_word> states_;
};

}  // namespace scree
