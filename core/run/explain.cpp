#include "core/run/explain.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/isa.hpp"
#include "core/base/log.hpp"
#include "core/scene/use.hpp"

namespace scree::core {

namespace {

using Stored = Explanation::Stored;

std::string word_name(const scree_contact_model& model, uint32_t word) {
  for (uint32_t k = 0; k < model.property_count; ++k) {
    const scree_property& property = model.properties[k];
    if (word >= property.word && word < property.word + property.words) return property.name;
  }
  return "word " + std::to_string(word);
}

std::string varying_names(const BoundRule& rule) {
  std::string names;
  for (const uint32_t word : rule.varying) names += (names.empty() ? "" : ", ") + word_name(*rule.model, word);
  return names;
}

std::string law_text(const BoundRule& rule) {
  return fmt::format("{}: {}, {}, {}", rule.name, rule.model_name,
                     rule.normal_only() ? "normal force only" : "normal and tangential part",
                     rule.varying.empty() ? "uniform properties" : "per contact: " + varying_names(rule));
}

std::string unit_in(const Use& use, uint32_t property) { return unit_of(use.component->properties()[property]); }

/// What is drawn on the rules, and on the balls that rules mix.
void add_draws(const Simulation& simulation, std::vector<std::string>& steps) {
  for (const Rule& rule : simulation.rules)
    for (const Setting& setting : rule.model.settings)
      if (setting.drawn != nullptr)
        steps.push_back(rule.name + "." + setting.name +
                        " of each contact: " + setting.drawn->text(unit_in(rule.model, setting.property)));
  for (const BallSet& set : simulation.ball_sets)
    for (const PieceProperty& piece : set.contact)
      if (piece.drawn != nullptr)
        steps.push_back(set.name + "." + piece.name + " of each ball, in SI units: " + piece.drawn->text("1"));
}

std::vector<std::string> law_steps(const Simulation& simulation) {
  std::vector<std::string> steps;
  const RuleBook& book = simulation.engine.contacts.book;
  for (const BoundRule& rule : book.rules)
    steps.push_back(rule.model != nullptr ? law_text(rule) : rule.name + ": none, these pairs do not interact");
  if (steps.empty()) steps.push_back("no rule");
  add_draws(simulation, steps);
  return steps;
}

/// Does some group meet the wall under the rule?
bool meets(const RuleBook& book, std::size_t wall, std::size_t rule) {
  for (std::size_t group = 0; group < book.groups(); ++group)
    if (book.wall(static_cast<uint16_t>(group), static_cast<uint16_t>(wall)) == rule) return true;
  return false;
}

std::vector<std::string> wall_steps(const Engine& engine) {
  std::vector<std::string> steps;
  const RuleBook& book = engine.contacts.book;
  for (std::size_t w = 0; w < std::min(engine.walls.size(), book.walls()); ++w)
    for (std::size_t r = 0; r < book.rules.size(); ++r)
      if (book.rules[r].model != nullptr && meets(book, w, r))
        steps.push_back(engine.walls[w].name + ": rule " + book.rules[r].name);
  if (steps.empty()) steps.push_back("nothing");
  return steps;
}

std::vector<std::string> motion_steps(const Engine& engine) {
  std::vector<std::string> steps{"halo sum, in the order of blocks"};
  for (const bool adding : {true, false})
    for (const Process* process : row_order(engine.processes, adding))
      steps.push_back("process " + process->name + (adding ? ": adds forces" : ": scales forces"));
  steps.push_back("kick");
  steps.push_back("drift");
  return steps;
}

std::vector<std::string> model_steps(const Engine& engine) {
  std::vector<std::string> steps;
  for (const Process& process : engine.processes)
    if (process.table->step != nullptr)
      steps.push_back(process.name +
                      (process.table->every > 1 ? " every " + std::to_string(process.table->every) + " cycles" : ""));
  if (steps.empty()) steps.push_back("nothing");
  return steps;
}

std::string span_text(const Span& span) {
  if (span.cycles) return fmt::format("{} cycles", *span.cycles);
  return span.time ? fmt::format("{:g} s", *span.time) : "any time";
}

std::string until_text(const Until& until) {
  constexpr const char* words[] = {"below", "above", "falls to", "rises to"};
  return fmt::format("{} {} {:g}", until.quantity->text(), words[static_cast<std::size_t>(until.test)], until.value);
}

std::vector<std::string> stop_steps(const Simulation& simulation) {
  std::vector<std::string> steps{
      fmt::format("guards: finite numbers, overlap at most {:g} of the radius, displacement per cycle, count of balls",
                  simulation.engine.overlap_limit)};
  for (const Stage& stage : simulation.scene.stages)
    for (const Action& action : stage.actions)
      if (const auto* run = std::get_if<RunAction>(&action.what))
        for (const Until& until : run->until) steps.push_back("stage " + stage.name + ": " + until_text(until));
  return steps;
}

std::vector<std::string> record_steps(const Scene& scene) {
  std::vector<std::string> steps;
  for (const Record& record : scene.record)
    steps.push_back(fmt::format("{}: {}, every {}", record.name,
                                record.writer.component ? record.writer.component->name : "", span_text(record.every)));
  if (steps.empty()) steps.push_back("nothing");
  return steps;
}

std::vector<Explanation::Phase> phases(const Simulation& simulation) {
  const Engine& engine = simulation.engine;
  std::string detect = "nothing: the scene has no ball";
  if (engine.balls.size() > 0)
    detect = fmt::format("when the skin of {:.6g} m is used up: order of rows, hash, lists, step", engine.skin());
  std::vector<std::string> detection{detect};
  if (engine.step.automatic() && !engine.estimated().empty()) detection.push_back("step: " + engine.estimated());
  return {{"detect", detection},
          {"contact laws", law_steps(simulation)},
          {"wall contacts", wall_steps(engine)},
          {"motion", motion_steps(engine)},
          {"model processes", model_steps(engine)},
          {"stop tests", stop_steps(simulation)},
          {"record", record_steps(simulation.scene)}};
}

std::vector<Stored> ball_storage(const Engine& engine) {
  std::vector<Stored> out;
  for (const Balls::Listed& column : engine.balls.list())
    out.push_back({column.name, column.reason, column.bytes_per_ball});
  const bool spins = engine.contacts.book.spins();
  const std::size_t words = spins ? Slices::with_spin : Slices::lean;
  out.push_back({"force record", spins ? "force, moment and sum of contact force sizes" : "force and sum of its sizes",
                 words * sizeof(double)});
  for (const BoundRule& rule : engine.contacts.book.rules)
    if (rule.model != nullptr) out.push_back({"list of " + rule.name, "first pair of the ball", sizeof(uint64_t)});
  return out;
}

void add_columns(const BoundRule& rule, bool bonded, std::vector<Stored>& out) {
  uint32_t named = 0;
  const uint32_t words = rule.memory_words(bonded);
  for (uint32_t k = 0; k < rule.model->state_count; ++k) {
    const scree_state_word& state = rule.model->states[k];
    if (state.word >= words) continue;
    out.push_back({state.name, "remembered by " + rule.model_name, state.words * sizeof(double)});
    named += state.words;
  }
  if (words > named) out.push_back({"state", "remembered by " + rule.model_name, (words - named) * sizeof(double)});
  for (const uint32_t word : rule.varying)
    out.push_back({word_name(*rule.model, word), "differs from contact to contact", sizeof(double)});
}

std::vector<Explanation::RuleStorage> contact_storage(const Engine& engine) {
  std::vector<Explanation::RuleStorage> out;
  const Contacts& contacts = engine.contacts;
  for (std::size_t r = 0; r < contacts.book.rules.size(); ++r) {
    const BoundRule& rule = contacts.book.rules[r];
    if (rule.model == nullptr) continue;
    for (const bool bonded : {false, true}) {
      const std::size_t index = bonded ? contacts.lists().size() / 2 + r : r;
      const std::size_t listed = index < contacts.lists().size() ? contacts.lists()[index].size() : 0;
      if (bonded && listed == 0) continue;
      Explanation::RuleStorage storage{bonded ? rule.name + " (bonded)" : rule.name, rule.model_name, listed, {}};
      storage.parts = {{"other", "row of the other ball", sizeof(uint32_t)},
                       {"where", "force record of the other ball, image, orientation", sizeof(uint32_t)},
                       {"active", "its law runs", sizeof(uint8_t)}};
      if (bonded) storage.parts.push_back({"broken", "how the bond broke", sizeof(uint8_t)});
      add_columns(rule, bonded, storage.parts);
      out.push_back(std::move(storage));
    }
  }
  return out;
}

std::size_t sum(const std::vector<Stored>& parts) {
  std::size_t bytes = 0;
  for (const Stored& part : parts) bytes += part.bytes;
  return bytes;
}

Explanation::Memory memory(const Engine& engine, const Explanation& explanation) {
  // Listed pairs per ball. A loose packing that settled with the automatic skin lists 3.5 (the demo); this leaves room
  // for a denser one. It is a forecast and no limit.
  constexpr double dense_pairs = 5;
  // The pair table that a rebuild makes before it fills the lists.
  constexpr double table_pair = sizeof(uint32_t) + sizeof(uint8_t);
  Explanation::Memory out;
  for (const Balls::Listed& column : engine.balls.list()) out.balls += column.bytes;
  out.contacts = engine.contacts.bytes();
  std::size_t slot = 0;
  for (const auto& rule : explanation.per_contact) slot = std::max(slot, sum(rule.parts));
  const double per_ball = static_cast<double>(sum(explanation.per_ball)) +
                          dense_pairs * (static_cast<double>(slot) + table_pair) + sizeof(uint64_t);
  const double dense = static_cast<double>(explanation.balls) * per_ball;
  out.dense = std::max(static_cast<uint64_t>(dense), out.balls + out.contacts);
  return out;
}

Explanation::StageLength length_of(const Stage& stage, double dt) {
  Explanation::StageLength length{stage.name, 0, false};
  for (const Action& action : stage.actions) {
    const auto* run = std::get_if<RunAction>(&action.what);
    if (run == nullptr) continue;
    length.at_most = length.at_most || !run->until.empty();
    if (run->length.cycles && length.cycles)
      *length.cycles += *run->length.cycles;
    else if (run->length.time && dt > 0 && length.cycles)
      *length.cycles += static_cast<uint64_t>(std::ceil(*run->length.time / dt));
    else
      length.cycles.reset();
  }
  return length;
}

std::optional<Explanation::Step> step_of(const Engine& engine) {
  if (engine.step.step() == 0) return std::nullopt;
  const StepBound& bound = engine.step.bound();
  return Explanation::Step{engine.step.step(), bound.step, engine.step.automatic(), bound.text()};
}

void edit_until_first_run(Simulation& simulation) {
  for (const Stage& stage : simulation.scene.stages)
    for (const Action& action : stage.actions) {
      if (std::holds_alternative<RunAction>(action.what)) return;
      if (!std::holds_alternative<SaveAction>(action.what)) simulation.edit(action);
    }
}

}  // namespace

void stand_before_first_cycle(Simulation& simulation) {
  edit_until_first_run(simulation);
  simulation.prepare();
  if (simulation.engine.balls.size() > 0) simulation.engine.detect();
}

Explanation explain(const Simulation& simulation) {
  const Engine& engine = simulation.engine;
  Explanation out;
  out.scene = simulation.scene.file;
  out.balls = engine.balls.size();
  out.walls = engine.walls.size();
  out.listed = engine.contacts.listed();
  std::set<std::pair<Kind, std::string>> found;
  for (const Found& file : simulation.catalogue.found()) found.insert({file.kind, file.name});
  out.plugins_found = found.size();
  for (const Component* component : simulation.catalogue.opened())
    out.plugins.push_back({kind_name(component->kind), component->name, component->version, component->file.string()});
  out.cycle = phases(simulation);
  out.per_ball = ball_storage(engine);
  out.per_contact = contact_storage(engine);
  if (!engine.walls.empty())
    out.per_wall_contact = {{"record", "ball, patch, normal of the last pass", sizeof(WallSlot)}};
  const RuleBook& book = engine.contacts.book;
  for (std::size_t wall = 0; wall < std::min(engine.walls.size(), book.walls()); ++wall)
    for (std::size_t rule = 0; rule < book.rules.size(); ++rule)
      if (out.per_wall_contact.size() == 1 && book.rules[rule].can_bond() && meets(book, wall, rule))
        out.per_wall_contact.push_back({"bond", "where it holds; of a bonded contact only", sizeof(WallBond)});
  out.left_out = left_out(simulation);
  out.step = step_of(engine);
  for (const Stage& stage : simulation.scene.stages) out.stages.push_back(length_of(stage, engine.step.step()));
  out.memory = memory(engine, out);
  return out;
}

}  // namespace scree::core
