#include "core/plugin/table_check.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "core/plugin/table_copy.hpp"

namespace scree::core {
namespace {

bool good_name(const char* name) {
  if (name == nullptr || *name == '\0') return false;
  std::size_t length = 0;
  for (const char* c = name; *c; ++c, ++length) {
    const bool letter = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || *c == '_';
    const bool digit = *c >= '0' && *c <= '9';
    if (!letter && !(digit && length > 0)) return false;
    if (length > 64) return false;
  }
  return true;
}

uint32_t words_of(uint32_t type) { return type == SCREE_VECTOR ? 3 : 1; }

void check_bounds(const scree_property& p, const TableRefusal& refuse) {
  const std::string called = std::string("property '") + p.name + "' ";
  if (p.mix > SCREE_MIX_HARMONIC) refuse(called + "has an unknown rule of mixing");
  const bool low = (p.flags & SCREE_HAS_LOW) != 0, high = (p.flags & SCREE_HAS_HIGH) != 0;
  if ((low && std::isnan(p.low)) || (high && std::isnan(p.high)) || (low && high && p.low > p.high))
    refuse(called + "has bounds that no value fits");
  if ((p.flags & SCREE_HAS_FALLBACK) != 0 &&
      (std::isnan(p.fallback) || (low && p.fallback < p.low) || (high && p.fallback > p.high)))
    refuse(called + "has a default outside its own bounds");
}

void check_properties(const scree_property* rows, uint32_t count, const TableRefusal& refuse, bool columns);

void check_property(const scree_property& p, uint32_t index, const TableRefusal& refuse, bool column) {
  if (!good_name(p.name)) refuse("property " + std::to_string(index + 1) + " has no usable name (letters, digits, _)");
  const std::string called = std::string("property '") + p.name + "' ";
  if (p.type < SCREE_NUMBER || p.type > SCREE_TABLE || (column && p.type == SCREE_TABLE))
    refuse(called + "has an unknown type");
  if (p.unit == nullptr || p.doc == nullptr) refuse(called + "has no unit or no description");
  if (p.type == SCREE_TABLE) {
    if (p.column_count == 0 || p.columns == nullptr) refuse(called + "is a table without columns");
    check_properties(p.columns, p.column_count, refuse, true);
  }
  check_bounds(p, refuse);
}

void check_properties(const scree_property* rows, uint32_t count, const TableRefusal& refuse, bool columns) {
  std::set<std::string_view> names;
  for (uint32_t k = 0; k < count; ++k) {
    check_property(rows[k], k, refuse, columns);
    if (!names.insert(rows[k].name).second) refuse(std::string("property '") + rows[k].name + "' is there twice");
  }
}

template <class F>
void check_present(F* function, const char* name, const TableRefusal& refuse) {
  if (function == nullptr) refuse(std::string("its function '") + name + "' is missing");
}

void check_forms(const scree_contact_model& m, const TableRefusal& refuse) {
  if (m.form_count == 0) return;
  if (m.form_count > 32 || m.forms == nullptr) refuse("its list of input forms is not sound");
  for (uint32_t form = 0; form < m.form_count; ++form) {
    std::string_view rest = m.forms[form] ? m.forms[form] : "";
    if (rest.empty()) refuse("input form " + std::to_string(form + 1) + " is empty");
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(' '), rest.size());
      const std::string_view word = rest.substr(0, end);
      rest.remove_prefix(std::min(end + 1, rest.size()));
      bool known = false;
      for (uint32_t k = 0; k < m.property_count; ++k) known = known || word == m.properties[k].name;
      if (!known)
        refuse("its input form '" + std::string(m.forms[form]) + "' names '" + std::string(word) +
               "', which is no property");
    }
  }
}

void check_words(const scree_contact_model& m, const TableRefusal& refuse) {
  if (m.rule_words == 0 || m.rule_words > 4096 || m.state_words > 4096 || m.bond_words > 4096)
    refuse("its rule, state or bond has an impossible size");
  for (uint32_t k = 0; k < m.property_count; ++k) {
    const scree_property& p = m.properties[k];
    const std::string called = std::string("property '") + p.name + "' ";
    if (p.type > SCREE_VECTOR) refuse(called + "is not a number or vector, as those of a contact model are");
    if (p.words != words_of(p.type) || p.words > m.rule_words || p.word > m.rule_words - p.words)
      refuse(called + "lies outside the model's struct");
    if (m.form_count < 32 && (p.forms >> m.form_count) != 0) refuse(called + "belongs to an unknown form");
  }
  if (m.state_count > 4096 || (m.state_count > 0 && m.states == nullptr))
    refuse("its list of remembered members is not sound");
  const uint32_t memory = m.state_words + m.bond_words;
  for (uint32_t k = 0; k < m.state_count; ++k) {
    const scree_state_word& s = m.states[k];
    if (!good_name(s.name) || s.unit == nullptr || s.words > memory || s.word > memory - s.words)
      refuse("remembered member " + std::to_string(k + 1) + " has no name or lies outside State and Bond");
  }
}

void check_contact_model(const scree_contact_model& m, const TableRefusal& refuse) {
  check_properties(m.properties, m.property_count, refuse, false);
  check_words(m, refuse);
  check_forms(m, refuse);
  check_present(m.uniform[0], "law", refuse);
  check_present(m.varying[0], "law for varying properties", refuse);
  check_present(m.stiffness, "stiffness", refuse);
  if (m.derived_from_pair != 0) check_present(m.derive, "derive", refuse);
  if (m.needs != nullptr) check_present(m.normal_only[0], "law_normal", refuse);
  if ((m.flags & SCREE_CAN_BOND) != 0) {
    check_present(m.bonded[0], "law for bonded contacts", refuse);
    check_present(m.bonded_varying[0], "law for bonded contacts with varying properties", refuse);
  }
}

void check_object(const scree_object& o, const TableRefusal& refuse) {
  check_properties(o.properties, o.property_count, refuse, false);
  check_present(o.create, "create", refuse);
  check_present(o.destroy, "destroy", refuse);
  if (o.property_count > 0) check_present(o.set, "set", refuse);
}

void check_process(const scree_process& p, const TableRefusal& refuse) {
  check_object(p.object, refuse);
  if (p.rows[0] == nullptr && p.step == nullptr && (p.flags & SCREE_TRACES_ENERGY) == 0)
    refuse("it has neither 'rows' nor 'step', so it does nothing");
  if (p.need_count > most_needs || (p.need_count > 0 && p.needs == nullptr))
    refuse("its list of needed columns is not sound");
  for (uint32_t k = 0; k < p.need_count; ++k)
    if (p.needs[k].column >= SCREE_COLUMN_COUNT) refuse("it needs a column that this scree does not know");
  if ((p.flags & SCREE_LOCAL_DAMPING) != 0) check_present(p.damping, "damping", refuse);
}

void check(Kind kind, const void* table, const TableRefusal& refuse) {
  switch (kind) {
    case Kind::contact_model:
      return check_contact_model(*static_cast<const scree_contact_model*>(table), refuse);
    case Kind::wall: {
      const auto& wall = *static_cast<const scree_wall*>(table);
      check_object(wall.object, refuse);
      return check_present(wall.touch, "touch", refuse);
    }
    case Kind::generator: {
      const auto& generator = *static_cast<const scree_generator*>(table);
      check_object(generator.object, refuse);
      return check_present(generator.generate, "generate", refuse);
    }
    case Kind::process:
      return check_process(*static_cast<const scree_process*>(table), refuse);
    case Kind::writer: {
      const auto& writer = *static_cast<const scree_writer*>(table);
      check_object(writer.object, refuse);
      check_present(writer.open, "open", refuse);
      return check_present(writer.frame, "frame", refuse);
    }
  }
}

}  // namespace

std::shared_ptr<const void> checked_table(Kind kind, const std::string& name, const void* theirs,
                                          const std::filesystem::path& file) {
  const TableRefusal refuse{file.string() + ": " + kind_name(kind) + " '" + name + "': "};
  std::shared_ptr<const void> table = copy_table(kind, theirs, refuse);
  check(kind, table.get(), refuse);
  return table;
}

}  // namespace scree::core
