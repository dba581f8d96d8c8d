#include <algorithm>
#include <set>

#include "core/run/explain.hpp"

namespace scree::core {

namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

std::vector<std::string> rules_with(const RuleBook& book, bool normal_only) {
  std::vector<std::string> names;
  for (const BoundRule& rule : book.rules)
    if (rule.model != nullptr && rule.normal_only() == normal_only) names.push_back(rule.name);
  return names;
}

std::string quoted_rules(const std::vector<std::string>& names) {
  return (names.size() == 1 ? "rule '" : "rules '") + joined(names) + "'";
}

/// Every name that any expression of the scene reads.
std::set<std::string> names_read(const Scene& scene) {
  std::set<std::string> names;
  const auto add = [&](const std::shared_ptr<Formula>& formula) {
    if (formula) names.insert(formula->names().begin(), formula->names().end());
  };
  for (const Quantity& quantity : scene.quantities) add(quantity.formula);
  for (const Record& record : scene.record)
    for (const auto& formula : record.quantities) add(formula);
  for (const Expect& expect : scene.expect) add(expect.quantity);
  for (const Stage& stage : scene.stages)
    for (const Action& action : stage.actions)
      if (const auto* run = std::get_if<RunAction>(&action.what))
        for (const Until& until : run->until) add(until.quantity);
  return names;
}

void about_spin(const Simulation& simulation, std::vector<std::string>& out) {
  const RuleBook& book = simulation.engine.contacts.book;
  const std::vector<std::string> lean = rules_with(book, true), full = rules_with(book, false);
  if (!simulation.engine.balls.has(Column::wx)) {
    const std::string why = lean.empty() ? "no rule has a law"
                                         : quoted_rules(lean) + (lean.size() == 1 ? " has" : " have") +
                                               " no tangential part (no friction or no shear stiffness)";
    out.push_back("spin and moment of balls: " + why + ", and no process asked for them");
  }
  for (const BoundRule& rule : book.rules)
    if (rule.model != nullptr && rule.normal_only() && rule.model->state_words > 0)
      out.push_back("what contacts of rule '" + rule.name + "' would remember, " +
                    std::to_string(8 * rule.model->state_words) + " bytes each: the rule has no tangential part");
  std::vector<std::string> uniform;
  for (const BoundRule& rule : book.rules)
    if (rule.model != nullptr && rule.varying.empty()) uniform.push_back(rule.name);
  if (!uniform.empty())
    out.push_back("properties per contact: they are the same for all contacts of " + quoted_rules(uniform));
}

void about_columns(const Simulation& simulation, std::vector<std::string>& out) {
  const Engine& engine = simulation.engine;
  if (!engine.balls.has(Column::force_x)) out.push_back("applied force: no 'apply' gave one so far");
  if (!engine.balls.has(Column::moment_x)) out.push_back("applied moment: no 'apply' gave one so far");
  if (engine.balls.fixed() == nullptr) out.push_back("fixed directions: no ball is fixed");
  if (!engine.cell.any()) out.push_back("periodic shifts: the scene has no periodic cell");
  if (engine.walls.empty()) out.push_back("wall contacts: the scene has no wall");
}

void about_processes(const Simulation& simulation, std::vector<std::string>& out) {
  bool rows = false, models = false;
  for (const Process& process : simulation.engine.processes) {
    rows = rows || process.has_rows();
    models = models || process.table->step != nullptr;
  }
  if (!rows) out.push_back("row processes: the scene names none");
  if (!models) out.push_back("model processes: the scene names none");
}

bool shows_contacts(const Record& record) {
  return std::any_of(record.fields.begin(), record.fields.end(),
                     [](const Name& field) { return field.text.starts_with("contact."); });
}

void about_output(const Simulation& simulation, std::vector<std::string>& out) {
  const Scene& scene = simulation.scene;
  // `contacts.sliding` and `contacts.ID1.ID2.*` are read from the contacts; other counts are not.
  bool contacts = std::any_of(scene.record.begin(), scene.record.end(), shows_contacts), sums = false;
  for (const std::string& name : names_read(scene)) {
    contacts = contacts || name.starts_with("contacts.sliding") ||
               (name.starts_with("contacts.") && name.find_first_of("0123456789") == 9);
    sums = sums || name.starts_with("unbalanced");
  }
  if (scene.record.empty()) out.push_back("histories and views: the scene has no 'record'");
  if (!contacts) out.push_back("force, moment and sliding of each contact: nothing records or reads them");
  if (!sums) out.push_back("sums of contact force sizes: nothing reads 'unbalanced'");
}

void about_plugins(const Simulation& simulation, std::vector<std::string>& out) {
  std::set<std::pair<Kind, std::string>> opened;
  for (const Component* component : simulation.catalogue.opened()) opened.insert({component->kind, component->name});
  std::vector<std::string> closed;
  std::set<std::pair<Kind, std::string>> seen;
  for (const Found& found : simulation.catalogue.found())
    if (!opened.contains({found.kind, found.name}) && seen.insert({found.kind, found.name}).second)
      closed.push_back(std::string(kind_name(found.kind)) + " " + found.name);
  if (!closed.empty())
    out.push_back(std::to_string(closed.size()) + " plug-in" + (closed.size() == 1 ? "" : "s") +
                  " found and not opened: the scene does not name " + joined(closed));
}

}  // namespace

std::vector<std::string> left_out(const Simulation& simulation) {
  std::vector<std::string> out;
  about_spin(simulation, out);
  about_columns(simulation, out);
  about_processes(simulation, out);
  about_output(simulation, out);
  about_plugins(simulation, out);
  return out;
}

}  // namespace scree::core
