#include "core/run/use_state.hpp"

#include <algorithm>
#include <cmath>

#include "core/scene/use.hpp"

namespace scree::core {

namespace {

void pack(Packer& out, const Place& place) {
  out.text(place.file);
  out.u64(static_cast<uint64_t>(place.line));
  out.u64(static_cast<uint64_t>(place.column));
}

void pack(Packer& out, const std::shared_ptr<Formula>& formula) { out.text(formula == nullptr ? "" : formula->text()); }

void pack(Packer& out, const std::shared_ptr<Distribution>& drawn) {
  out.flag(drawn != nullptr);
  if (drawn == nullptr) return;
  out.u64(static_cast<uint64_t>(drawn->law()));
  for (const double number : {drawn->first(), drawn->second(), drawn->low(), drawn->high()}) out.f64(number);
}

void pack(Packer& out, const Value& value) {
  out.u64(value.type);
  out.u64(value.rows);
  out.u64(value.columns);
  out.u64(value.numbers.size());
  out.f64s(value.numbers.data(), value.numbers.size());
  out.u64(value.texts.size());
  for (const std::string& text : value.texts) out.text(text);
}

void pack(Packer& out, const Setting& setting) {
  out.text(setting.name);
  pack(out, setting.value);
  pack(out, setting.formula);
  pack(out, setting.drawn);
  pack(out, setting.place);
}

void pack(Packer& out, const PieceProperty& piece) {
  out.text(piece.name);
  out.f64(piece.value);
  out.text(piece.unit);
  pack(out, piece.formula);
  pack(out, piece.drawn);
  pack(out, piece.place);
}

void pack(Packer& out, const std::optional<Triple>& triple) {
  out.flag(triple.has_value());
  if (triple) out.f64s(triple->data(), 3);
}

std::optional<Triple> unpack_triple(Unpacker& in) {
  if (!in.flag()) return std::nullopt;
  Triple triple{};
  in.f64s(triple.data(), 3);
  return triple;
}

// A component trusts the shape of a value, because the scene's reader made sure of it.
bool fits(const scree_property& property, const Value& value) {
  const bool is_text = property.type == SCREE_TEXT || property.type == SCREE_TEXTS;
  if (value.type != property.type) return false;
  if (is_text) return value.numbers.empty() && (property.type == SCREE_TEXTS || value.texts.size() == 1);
  uint32_t columns = property.type == SCREE_VECTOR || property.type == SCREE_VECTORS ? 3 : 1;
  if (property.type == SCREE_TABLE) {
    columns = 0;
    for (uint32_t c = 0; c < property.column_count; ++c)
      columns = std::max(columns, property.columns[c].word + property.columns[c].words);
  }
  const bool many = property.type == SCREE_NUMBERS || property.type == SCREE_VECTORS || property.type == SCREE_TABLE;
  return value.texts.empty() && value.columns == columns && (many || value.rows == 1) &&
         value.numbers.size() == uint64_t{value.rows} * columns;
}

}  // namespace

void pack(Packer& out, const Use& use) {
  out.text(use.component->name);
  out.u64(use.form);
  pack(out, use.place);
  out.u64(use.settings.size());
  for (const Setting& setting : use.settings) pack(out, setting);
}

void pack(Packer& out, const Rule& rule) {
  out.text(rule.name);
  for (const auto& side : rule.between) {
    out.u64(side.size());
    for (const std::string& name : side) out.text(name);
  }
  pack(out, rule.place);
  out.flag(rule.none);
  if (!rule.none) pack(out, rule.model);
}

void pack(Packer& out, const BallSet& set) {
  out.text(set.name);
  pack(out, set.generator);
  out.flag(set.density.has_value());
  out.f64(set.density.value_or(0));
  out.u64(set.contact.size());
  for (const PieceProperty& piece : set.contact) pack(out, piece);
  out.flag(set.fixed);
  pack(out, set.velocity);
  pack(out, set.spin);
  pack(out, set.place);
}

Place UseReader::place() {
  Place place;
  place.file = in.text();
  place.line = static_cast<int>(in.u64());
  place.column = static_cast<int>(in.u64());
  return place;
}

std::shared_ptr<Formula> UseReader::formula(const Place& at) {
  const std::string text = in.text();
  if (text.empty()) return nullptr;
  try {
    return std::make_shared<Formula>(text, vars, at);
  } catch (const Refusal& refusal) {
    in.refuse("an expression cannot be read: " + std::string(refusal.what()));
  }
}

std::shared_ptr<Distribution> UseReader::drawn() {
  if (!in.flag()) return nullptr;
  const uint64_t law = in.u64();
  const double first = in.f64(), second = in.f64(), low = in.f64(), high = in.f64();
  if (law > static_cast<uint64_t>(Distribution::Law::weibull)) in.refuse("a distribution has an unknown law");
  auto out = std::make_shared<Distribution>(static_cast<Distribution::Law>(law), first, second);
  out->cut(low, high);
  const bool good = std::isfinite(first) && second >= 0 && std::isfinite(second) && out->kept() > 0;
  if (!good || (out->law() == Distribution::Law::weibull && !(first > 0 && second > 0)))
    in.refuse("a distribution has parameters that no scene could give");
  return out;
}

Value UseReader::value(const scree_property& property) {
  Value value;
  value.type = static_cast<uint32_t>(in.u64());
  value.rows = static_cast<uint32_t>(in.u64());
  value.columns = static_cast<uint32_t>(in.u64());
  value.numbers.resize(static_cast<std::size_t>(in.count()));
  in.f64s(value.numbers.data(), value.numbers.size());
  for (uint64_t left = in.count(); left > 0; --left) value.texts.push_back(in.text());
  // The value of an expression is not known before it meets a place.
  const bool empty = value.numbers.empty() && value.texts.empty();
  if (!empty && !fits(property, value))
    in.refuse(std::string("the value of '") + property.name + "' has a wrong shape");
  return value;
}

Setting UseReader::setting(const Component& component) {
  Setting setting;
  setting.name = in.text();
  const scree_property* property = find_property(component, setting.name, &setting.property);
  if (property == nullptr)
    in.refuse(std::string(kind_name(component.kind)) + " '" + component.name + "' has no property '" + setting.name +
              "'");
  setting.value = value(*property);
  setting.formula = formula({});
  setting.drawn = drawn();
  setting.place = place();
  if (setting.formula == nullptr && setting.drawn == nullptr && !fits(*property, setting.value))
    in.refuse("'" + setting.name + "' has no value");
  for (const std::string& name : setting.formula == nullptr ? std::vector<std::string>() : setting.formula->names())
    if (name != "x" && name != "y" && name != "z") in.refuse("an expression uses '" + name + "'");
  return setting;
}

PieceProperty UseReader::piece() {
  PieceProperty piece;
  piece.name = in.text();
  piece.value = in.f64();
  piece.unit = in.text();
  piece.formula = formula({});
  piece.drawn = drawn();
  piece.place = place();
  return piece;
}

Use UseReader::use(Kind kind) {
  Use use;
  use.component = &catalogue.open(kind, in.text());
  use.form = static_cast<uint32_t>(in.u64());
  if (kind == Kind::contact_model && use.form >= std::max(1u, use.component->contact_model().form_count))
    in.refuse("contact model '" + use.component->name + "' has no such input form");
  use.place = place();
  for (uint64_t left = in.count(); left > 0; --left) use.settings.push_back(setting(*use.component));
  return use;
}

Rule UseReader::rule() {
  Rule rule;
  rule.name = in.text();
  for (auto& side : rule.between)
    for (uint64_t left = in.count(); left > 0; --left) side.push_back(in.text());
  rule.place = place();
  rule.none = in.flag();
  if (!rule.none) rule.model = use(Kind::contact_model);
  return rule;
}

BallSet UseReader::ball_set() {
  BallSet set;
  set.name = in.text();
  set.generator = use(Kind::generator);
  const bool dense = in.flag();
  const double density = in.f64();
  if (dense) set.density = density;
  for (uint64_t left = in.count(); left > 0; --left) set.contact.push_back(piece());
  set.fixed = in.flag();
  set.velocity = unpack_triple(in);
  set.spin = unpack_triple(in);
  set.place = place();
  return set;
}

}  // namespace scree::core
