#include "core/plugin/table_check.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

namespace scree::core {
namespace {

/// Where and how a refusal speaks.
struct Speaker {
  std::string where;
  [[noreturn]] void refuse(const std::string& why) const {
    throw Refusal(Exit::plugin, where + why + ": build the plug-in with this SDK, or report it to its author");
  }
};

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

void check_bounds(const scree_property& p, const Speaker& speaker) {
  const std::string called = std::string("property '") + p.name + "' ";
  if (p.mix > SCREE_MIX_HARMONIC) speaker.refuse(called + "has an unknown rule of mixing");
  const bool low = (p.flags & SCREE_HAS_LOW) != 0, high = (p.flags & SCREE_HAS_HIGH) != 0;
  if ((low && std::isnan(p.low)) || (high && std::isnan(p.high)) || (low && high && p.low > p.high))
    speaker.refuse(called + "has bounds that no value fits");
  if ((p.flags & SCREE_HAS_FALLBACK) != 0 &&
      (std::isnan(p.fallback) || (low && p.fallback < p.low) || (high && p.fallback > p.high)))
    speaker.refuse(called + "has a default outside its own bounds");
}

void check_properties(const scree_property* rows, uint32_t count, const Speaker& speaker, bool columns);

void check_property(const scree_property& p, uint32_t index, const Speaker& speaker, bool column) {
  if (p.struct_size != sizeof(scree_property))
    speaker.refuse("property " + std::to_string(index + 1) + " has " + std::to_string(p.struct_size) + " bytes, " +
                   std::to_string(sizeof(scree_property)) + " are expected");
  if (!good_name(p.name))
    speaker.refuse("property " + std::to_string(index + 1) + " has no usable name (letters, digits, _)");
  const std::string called = std::string("property '") + p.name + "' ";
  if (p.type < SCREE_NUMBER || p.type > SCREE_TABLE || (column && p.type == SCREE_TABLE))
    speaker.refuse(called + "has an unknown type");
  if (p.unit == nullptr || p.doc == nullptr) speaker.refuse(called + "has no unit or no description");
  if (p.type == SCREE_TABLE) {
    if (p.column_count == 0 || p.columns == nullptr) speaker.refuse(called + "is a table without columns");
    check_properties(p.columns, p.column_count, speaker, true);
  }
  check_bounds(p, speaker);
}

void check_properties(const scree_property* rows, uint32_t count, const Speaker& speaker, bool columns) {
  if (count > 1024 || (count > 0 && rows == nullptr)) speaker.refuse("its list of properties is not sound");
  std::set<std::string_view> names;
  for (uint32_t k = 0; k < count; ++k) {
    check_property(rows[k], k, speaker, columns);
    if (!names.insert(rows[k].name).second)
      speaker.refuse(std::string("property '") + rows[k].name + "' is there twice");
  }
}

void check_size(uint32_t is, std::size_t needed, const Speaker& speaker) {
  if (is < needed)
    speaker.refuse("its table has " + std::to_string(is) + " bytes, at least " + std::to_string(needed) +
                   " are needed");
}

template <class F>
void check_present(F* function, const char* name, const Speaker& speaker) {
  if (function == nullptr) speaker.refuse(std::string("its function '") + name + "' is missing");
}

void check_forms(const scree_contact_model& m, const Speaker& speaker) {
  if (m.form_count == 0) return;
  if (m.form_count > 32 || m.forms == nullptr) speaker.refuse("its list of input forms is not sound");
  for (uint32_t form = 0; form < m.form_count; ++form) {
    std::string_view rest = m.forms[form] ? m.forms[form] : "";
    if (rest.empty()) speaker.refuse("input form " + std::to_string(form + 1) + " is empty");
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(' '), rest.size());
      const std::string_view word = rest.substr(0, end);
      rest.remove_prefix(std::min(end + 1, rest.size()));
      bool known = false;
      for (uint32_t k = 0; k < m.property_count; ++k) known = known || word == m.properties[k].name;
      if (!known)
        speaker.refuse("its input form '" + std::string(m.forms[form]) + "' names '" + std::string(word) +
                       "', which is no property");
    }
  }
}

void check_words(const scree_contact_model& m, const Speaker& speaker) {
  if (m.rule_words == 0 || m.rule_words > 4096 || m.state_words > 4096 || m.bond_words > 4096)
    speaker.refuse("its rule, state or bond has an impossible size");
  for (uint32_t k = 0; k < m.property_count; ++k) {
    const scree_property& p = m.properties[k];
    const std::string called = std::string("property '") + p.name + "' ";
    if (p.type > SCREE_VECTOR) speaker.refuse(called + "is not a number or vector, as those of a contact model are");
    if (p.words != words_of(p.type) || p.words > m.rule_words || p.word > m.rule_words - p.words)
      speaker.refuse(called + "lies outside the model's struct");
    if (m.form_count < 32 && (p.forms >> m.form_count) != 0) speaker.refuse(called + "belongs to an unknown form");
  }
  if (m.state_count > 4096 || (m.state_count > 0 && m.states == nullptr))
    speaker.refuse("its list of remembered members is not sound");
  const uint32_t memory = m.state_words + m.bond_words;
  for (uint32_t k = 0; k < m.state_count; ++k) {
    const scree_state_word& s = m.states[k];
    if (!good_name(s.name) || s.unit == nullptr || s.words > memory || s.word > memory - s.words)
      speaker.refuse("remembered member " + std::to_string(k + 1) + " has no name or lies outside State and Bond");
  }
}

void check_contact_model(const scree_contact_model& m, const Speaker& speaker) {
  check_size(m.struct_size, sizeof m, speaker);
  check_properties(m.properties, m.property_count, speaker, false);
  check_words(m, speaker);
  check_forms(m, speaker);
  check_present(m.uniform[0], "law", speaker);
  check_present(m.varying[0], "law for varying properties", speaker);
  check_present(m.stiffness, "stiffness", speaker);
  if (m.derived_from_pair != 0) check_present(m.derive, "derive", speaker);
  if (m.needs != nullptr) check_present(m.normal_only[0], "law_normal", speaker);
  if ((m.flags & SCREE_CAN_BOND) != 0) {
    check_present(m.bonded[0], "law for bonded contacts", speaker);
    check_present(m.bonded_varying[0], "law for bonded contacts with varying properties", speaker);
  }
}

void check_object(const scree_object& o, const Speaker& speaker) {
  check_size(o.struct_size, sizeof o, speaker);
  check_properties(o.properties, o.property_count, speaker, false);
  check_present(o.create, "create", speaker);
  check_present(o.destroy, "destroy", speaker);
  if (o.property_count > 0) check_present(o.set, "set", speaker);
}

void check_process(const scree_process& p, const Speaker& speaker) {
  check_size(p.struct_size, sizeof p, speaker);
  check_object(p.object, speaker);
  if (p.rows[0] == nullptr && p.step == nullptr) speaker.refuse("it has neither 'rows' nor 'step', so it does nothing");
  if (p.need_count > most_needs || (p.need_count > 0 && p.needs == nullptr))
    speaker.refuse("its list of needed columns is not sound");
  for (uint32_t k = 0; k < p.need_count; ++k)
    if (p.needs[k].column >= SCREE_COLUMN_COUNT) speaker.refuse("it needs a column that this scree does not know");
  if ((p.flags & SCREE_LOCAL_DAMPING) != 0) check_present(p.damping, "damping", speaker);
}

}  // namespace

void check_table(Kind kind, const std::string& name, const void* table, const std::filesystem::path& file) {
  const Speaker speaker{file.string() + ": " + kind_name(kind) + " '" + name + "': "};
  if (table == nullptr) speaker.refuse("its description failed, so there is nothing to use");
  switch (kind) {
    case Kind::contact_model:
      return check_contact_model(*static_cast<const scree_contact_model*>(table), speaker);
    case Kind::wall: {
      const auto& wall = *static_cast<const scree_wall*>(table);
      check_size(wall.struct_size, sizeof wall, speaker);
      check_object(wall.object, speaker);
      return check_present(wall.touch, "touch", speaker);
    }
    case Kind::generator: {
      const auto& generator = *static_cast<const scree_generator*>(table);
      check_size(generator.struct_size, sizeof generator, speaker);
      check_object(generator.object, speaker);
      return check_present(generator.generate, "generate", speaker);
    }
    case Kind::process:
      return check_process(*static_cast<const scree_process*>(table), speaker);
    case Kind::writer: {
      const auto& writer = *static_cast<const scree_writer*>(table);
      check_size(writer.struct_size, sizeof writer, speaker);
      check_object(writer.object, speaker);
      check_present(writer.open, "open", speaker);
      return check_present(writer.frame, "frame", speaker);
    }
  }
}

}  // namespace scree::core
