#include <algorithm>

#include "core/scene/parts.hpp"
#include "core/scene/use.hpp"

namespace scree::core {
namespace {

const std::vector<std::string>& action_names() {
  static const std::vector<std::string> names = {"add",  "set",   "delete", "fix",   "free", "apply",
                                                 "bond", "solve", "run",    "cycle", "save", "include"};
  return names;
}

template <class Out, class Read>
void each_entry(Mapping& mapping, const std::string& key, std::vector<Out>& out, Context& context, Read read) {
  const Node* node = mapping.take(key);
  if (!node) return;
  Mapping entries(*node, "'" + key + "' of add", context);
  entries.rest([&](const Key& name, const Node& value) { out.push_back(read(name, value, context)); });
}

AddAction read_add(const Node& node, Context& context) {
  AddAction add;
  Mapping mapping(node, "action 'add'", context);
  each_entry(mapping, "walls", add.walls, context, read_wall);
  each_entry(mapping, "balls", add.balls, context, read_ball_set);
  each_entry(mapping, "processes", add.processes, context, read_process);
  if (const Node* rules = mapping.take("contacts")) {
    if (!rules->is_list())
      context.report.error(rules->place(), "'contacts' of add wants a list of rules, not " + describe(*rules));
    for (size_t i = 0; rules->is_list() && i < rules->items.size(); ++i)
      add.contacts.push_back(read_rule(rules->items[i], i, context));
  }
  mapping.finish();
  return add;
}

std::optional<DeleteAction> read_delete(const Node& node, Context& context) {
  DeleteAction out;
  Mapping mapping(node, "action 'delete'", context);
  if (!mapping.is_map()) return std::nullopt;
  for (const char* const what : {"walls", "balls", "contacts", "processes"}) {
    const Node* found = mapping.take(what);
    if (!found) continue;
    if (!out.what.empty())
      context.report.error(found->place(),
                           "one 'delete' names one kind: write a second action for '" + std::string(what) + "'");
    out.what = what;
    if (const auto name = read_word(*found, what, context)) out.name = {*name, found->place()};
  }
  if (out.what.empty())
    context.report.error(node.place(),
                         "action 'delete' wants walls, balls, contacts or processes, as in {walls: sides}");
  if (const Node* where = mapping.take("where")) {
    out.where = read_over_balls(*where, "where", context);
    if (out.what != "balls") context.report.error(where->place(), "'where' chooses among balls only");
  }
  mapping.finish();
  if (out.what.empty() || out.name.text.empty()) return std::nullopt;
  return out;
}

void read_axes(Mapping& mapping, const std::string& key, std::array<bool, 3>& axes, Context& context) {
  const Node* node = mapping.take(key);
  axes = {false, false, false};
  if (!node) return;
  for (const Name& axis : read_words(*node, key, context)) {
    if (axis.text == "x" || axis.text == "y" || axis.text == "z")
      axes[static_cast<size_t>(axis.text[0] - 'x')] = true;
    else
      context.report.error(axis.place, "'" + key + "' wants axes, as in [x, z], not '" + axis.text + "'");
  }
}

FixAction read_fix(bool fix, const Node& node, Context& context) {
  FixAction out;
  out.fix = fix;
  Mapping mapping(node, fix ? "action 'fix'" : "action 'free'", context);
  if (const Node* balls = mapping.need("balls"))
    if (const auto name = read_word(*balls, "balls", context)) out.balls = {*name, balls->place()};
  if (mapping.has("velocity") || mapping.has("spin")) {
    read_axes(mapping, "velocity", out.velocity, context);
    read_axes(mapping, "spin", out.spin, context);
  } else {
    mapping.take("velocity");
    mapping.take("spin");
  }
  if (const Node* where = mapping.take("where")) out.where = read_over_balls(*where, "where", context);
  mapping.finish();
  return out;
}

ApplyAction read_apply(const Node& node, Context& context) {
  ApplyAction out;
  Mapping mapping(node, "action 'apply'", context);
  if (const Node* balls = mapping.need("balls"))
    if (const auto name = read_word(*balls, "balls", context)) out.balls = {*name, balls->place()};
  const Node* force = mapping.take("force");
  const Node* moment = mapping.take("moment");
  if (force) out.force = read_triple(*force, {"force", "N"}, context).value_or(Triple{});
  if (moment) out.moment = read_triple(*moment, {"moment", "N m"}, context).value_or(Triple{});
  if (mapping.is_map() && !force && !moment)
    context.report.error(node.place(), "action 'apply' wants 'force' or 'moment', as in force: [0, 0, 10 N]");
  if (const Node* where = mapping.take("where")) out.where = read_over_balls(*where, "where", context);
  mapping.finish();
  return out;
}

std::optional<Until> read_test(const Key& key, const Node& node, Context& context) {
  Until until;
  until.place = key.spot.place();
  until.quantity = read_formula(key.text, until.place, "until", context);
  Mapping mapping(node, "the test of '" + key.text + "'", context);
  struct Word {
    const char* name;
    Until::Test test;
    const char* unit;
  };
  int tests = 0;
  bool good = until.quantity != nullptr;
  for (const Word& word :
       {Word{"below", Until::Test::below, ""}, Word{"above", Until::Test::above, ""},
        Word{"falls_to", Until::Test::falls_to, "1"}, Word{"rises_to", Until::Test::rises_to, "1"}}) {
    const Node* value = mapping.take(word.name);
    if (!value) continue;
    ++tests;
    until.test = word.test;
    const auto number = read_plain(*value, {word.name, word.unit}, context);
    good = good && number;
    until.value = number.value_or(0.0);
    if (number && *word.unit && !(*number > 0))
      context.report.error(value->place(), "'" + std::string(word.name) + "' must be above 0, not " + describe(*value));
  }
  if (tests != 1 && mapping.is_map())
    context.report.error(node.place(), mapping.what() + " wants one of below, above, falls_to, rises_to");
  mapping.finish();
  if (!good || tests != 1) return std::nullopt;
  return until;
}

void read_until(Mapping& mapping, RunAction& run, Context& context) {
  const Node* node = mapping.take("until");
  if (!node) return;
  Mapping tests(*node, "'until'", context);
  if (node->is_null() || (node->is_map() && node->items.empty()))
    context.report.error(node->place(), "'until' wants a test, as in {unbalanced: {below: 1e-3}}");
  tests.rest([&](const Key& key, const Node& value) {
    if (auto until = read_test(key, value, context)) run.until.push_back(std::move(*until));
  });
}

void read_unbalanced(const Node& node, RunAction& run, Context& context) {
  const auto limit = read_plain(node, {"unbalanced"}, context);
  if (!limit) return;
  if (!(*limit > 0)) context.report.error(node.place(), "'unbalanced' must be above 0, not " + describe(node));
  Until until;
  until.quantity = read_formula("unbalanced", node.place(), "unbalanced", context);
  until.value = *limit;
  until.place = node.place();
  if (until.quantity) run.until.push_back(std::move(until));
}

RunAction read_run(RunAction::Word word, const Key& key, const Node& node, Context& context) {
  RunAction run;
  run.word = word;
  const std::string what = "action '" + key.text + "'";
  if (word == RunAction::Word::cycle) {
    run.length.cycles = read_count(node, "cycle", true, context);
    return run;
  }
  if (!node.is_map()) {
    if (word == RunAction::Word::solve)
      read_unbalanced(node, run, context);
    else if (const auto span = read_span(node, "run", true, context))
      run.length = *span;
    return run;
  }
  Mapping mapping(node, what, context);
  if (word == RunAction::Word::solve)
    if (const Node* unbalanced = mapping.take("unbalanced")) read_unbalanced(*unbalanced, run, context);
  read_until(mapping, run, context);
  if (const Node* most = mapping.take("at_most"))
    if (const auto span = read_span(*most, "at_most", true, context)) run.length = *span;
  const bool ends = mapping.has("until") || mapping.has("unbalanced");
  if (word == RunAction::Word::solve && !ends)
    context.report.error(node.place(), what + " wants 'unbalanced' or 'until', as in {unbalanced: 1e-5}");
  if (word == RunAction::Word::run && !ends && !mapping.has("at_most"))
    context.report.error(node.place(), what + " would never end: give a time, 'until' or 'at_most'");
  mapping.finish();
  return run;
}

void read_set(const Node& node, std::vector<Action>& out, Context& context) {
  Mapping mapping(node, "action 'set'", context);
  mapping.rest([&](const Key& key, const Node& value) {
    if (auto assignment = read_assignment(key, value, context))
      out.push_back({std::move(*assignment), key.spot.place()});
  });
}

}  // namespace

std::optional<Action> read_action(const Key& key, const Node& node, Context& context) {
  Action action;
  action.place = key.spot.place();
  if (key.text == "add") {
    action.what = read_add(node, context);
  } else if (key.text == "delete") {
    auto what = read_delete(node, context);
    if (!what) return std::nullopt;
    action.what = std::move(*what);
  } else if (key.text == "fix" || key.text == "free") {
    action.what = read_fix(key.text == "fix", node, context);
  } else if (key.text == "apply") {
    action.what = read_apply(node, context);
  } else if (key.text == "bond") {
    action.what = read_bond(node, context);
  } else if (key.text == "run") {
    action.what = read_run(RunAction::Word::run, key, node, context);
  } else if (key.text == "cycle") {
    action.what = read_run(RunAction::Word::cycle, key, node, context);
  } else if (key.text == "solve") {
    action.what = read_run(RunAction::Word::solve, key, node, context);
  } else if (key.text == "save") {
    const auto name = read_word(node, "save", context);
    if (!name || !check_file_name(*name, node.place(), "saved state", context)) return std::nullopt;
    if (*name == stopped_state)
      context.report.error(node.place(),
                           "'" + *name + "' is the state that a numerical stop saves: choose another name");
    action.what = SaveAction{{*name, node.place()}};
  } else {
    context.report.error(action.place, "unknown action '" + key.text.substr(0, 60) + "'" +
                                           suggestion(key.text, action_names()) + "  (" + list_of(action_names()) +
                                           ")");
    return std::nullopt;
  }
  return action;
}

Stage read_stage(const Node& node, Context& context) {
  Stage stage;
  stage.place = node.place();
  if (!node.is_map() || node.items.size() != 1) {
    context.report.error(node.place(), "a stage is one name with its actions, as in `- settle: [run: 0.1 s]`");
    return stage;
  }
  const Key& name = node.keys[0];
  const Node& actions = node.items[0];
  stage.name = name.text;
  check_file_name(name.text, name.spot.place(), "stage", context);
  if (!actions.is_list() && !actions.is_null())
    context.report.error(actions.place(),
                         "stage '" + stage.name + "' wants a list of actions, as in [run: 0.1 s, save: packed]");
  if (!actions.is_list()) return stage;
  for (const Node& item : actions.items) {
    if (!item.is_map()) {
      context.report.error(item.place(),
                           "an action is a word with its value, as in `run: 0.1 s`, not " + describe(item));
      continue;
    }
    for (size_t i = 0; i < item.keys.size(); ++i) {
      if (item.keys[i].text == "set") {
        read_set(item.items[i], stage.actions, context);
      } else if (auto action = read_action(item.keys[i], item.items[i], context)) {
        stage.actions.push_back(std::move(*action));
      }
    }
  }
  return stage;
}

}  // namespace scree::core
