#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/log.hpp"
#include "core/run/explain.hpp"

namespace scree::core {

namespace {

using Json = nlohmann::ordered_json;
using Stored = Explanation::Stored;

std::string bytes_text(uint64_t bytes) {
  const double value = static_cast<double>(bytes);
  if (value >= 1e9) return fmt::format("{:.3g} GB", value / 1e9);
  if (value >= 1e6) return fmt::format("{:.3g} MB", value / 1e6);
  if (value >= 1e3) return fmt::format("{:.3g} kB", value / 1e3);
  return fmt::format("{} B", bytes);
}

const char* plural(uint64_t count) { return count == 1 ? "" : "s"; }

std::size_t sum(const std::vector<Stored>& parts) {
  std::size_t bytes = 0;
  for (const Stored& part : parts) bytes += part.bytes;
  return bytes;
}

std::string storage_text(const std::vector<Stored>& parts) {
  std::size_t width = 0;
  for (const Stored& part : parts) width = std::max(width, part.name.size());
  std::string out;
  for (const Stored& part : parts)
    out += fmt::format("  {:>4}  {:<{}}  {}\n", part.bytes, part.name, width, part.reason);
  return out;
}

std::string plugins_text(const Explanation& e) {
  std::string out = fmt::format("plug-ins: {} opened of {} found\n", e.plugins.size(), e.plugins_found);
  for (const auto& plugin : e.plugins)
    out += fmt::format("  {} {} {}  {}\n", plugin.kind, plugin.name, plugin.version, plugin.file);
  return out;
}

std::string cycle_text(const Explanation& e) {
  std::string out = "a cycle\n";
  for (std::size_t k = 0; k < e.cycle.size(); ++k) {
    out += fmt::format("  {}. {}\n", k + 1, e.cycle[k].name);
    for (const std::string& step : e.cycle[k].steps) out += "       " + step + "\n";
  }
  return out;
}

std::string contacts_text(const Explanation& e) {
  std::string out;
  for (const auto& rule : e.per_contact)
    out += fmt::format("bytes of a contact of rule {} ({}, {} pairs listed): {}\n", rule.rule, rule.model, rule.listed,
                       sum(rule.parts)) +
           storage_text(rule.parts);
  if (!e.per_wall_contact.empty())
    out +=
        fmt::format("bytes of a wall contact, beside state and properties of its rule: {}\n", sum(e.per_wall_contact)) +
        storage_text(e.per_wall_contact);
  return out;
}

std::string step_text(const Explanation& e) {
  if (!e.step) return "step: nothing limits it yet\n";
  const auto& step = *e.step;
  std::string out = fmt::format("step: {:.6g} s, {}", step.used, step.automatic ? "automatic" : "given by the scene");
  if (step.bound > 0)
    out += fmt::format("; stable limit {:.6g} s ({:.2f} of it used), governed by {}", step.bound,
                       step.used / step.bound, step.governed_by);
  return out + "\n";
}

std::string forecast_text(const Explanation& e) {
  std::string out = fmt::format("memory: balls {}, contacts {}; in a dense packing about {}\n",
                                bytes_text(e.memory.balls), bytes_text(e.memory.contacts), bytes_text(e.memory.dense));
  for (const auto& stage : e.stages) {
    if (stage.cycles)
      out += fmt::format("stage {}: {}{} cycles at this step, {:.3g} ball-steps\n", stage.name,
                         stage.at_most ? "at most " : "", *stage.cycles,
                         static_cast<double>(*stage.cycles) * static_cast<double>(e.balls));
    else
      out += fmt::format("stage {}: no length is known\n", stage.name);
  }
  return out;
}

Json storage_json(const std::vector<Stored>& parts) {
  Json out = Json::array();
  for (const Stored& part : parts) out.push_back({{"name", part.name}, {"bytes", part.bytes}, {"reason", part.reason}});
  return out;
}

Json contacts_json(const Explanation& e) {
  Json out = Json::array();
  for (const auto& rule : e.per_contact)
    out.push_back({{"rule", rule.rule},
                   {"model", rule.model},
                   {"listed", rule.listed},
                   {"bytes", sum(rule.parts)},
                   {"parts", storage_json(rule.parts)}});
  return out;
}

Json step_json(const Explanation::Step& step) {
  Json out{{"used", step.used}, {"automatic", step.automatic}};
  if (step.bound > 0) {
    out["bound"] = step.bound;
    out["governed_by"] = step.governed_by;
  }
  return out;
}

}  // namespace

std::string to_text(const Explanation& e) {
  std::string out = fmt::format("{}: {} ball{}, {} wall{}, {} pair{} listed\n\n", e.scene, e.balls, plural(e.balls),
                                e.walls, plural(e.walls), e.listed, plural(e.listed));
  out += plugins_text(e) + "\n" + cycle_text(e) + "\n";
  out += fmt::format("bytes of a ball: {}\n", sum(e.per_ball)) + storage_text(e.per_ball);
  out += contacts_text(e) + "\nleft out\n";
  for (const std::string& text : e.left_out) out += "  " + text + "\n";
  return out + "\n" + step_text(e) + forecast_text(e);
}

std::string to_json(const Explanation& e) {
  Json json{{"scene", e.scene}, {"balls", e.balls}, {"walls", e.walls}, {"pairs_listed", e.listed}};
  json["plugins_found"] = e.plugins_found;
  json["plugins"] = Json::array();
  for (const auto& p : e.plugins)
    json["plugins"].push_back({{"kind", p.kind}, {"name", p.name}, {"version", p.version}, {"library", p.file}});
  json["cycle"] = Json::array();
  for (const auto& phase : e.cycle) json["cycle"].push_back({{"phase", phase.name}, {"steps", phase.steps}});
  json["bytes_per_ball"] = sum(e.per_ball);
  json["per_ball"] = storage_json(e.per_ball);
  json["per_contact"] = contacts_json(e);
  if (!e.per_wall_contact.empty()) json["per_wall_contact"] = storage_json(e.per_wall_contact);
  json["left_out"] = e.left_out;
  if (e.step) json["timestep"] = step_json(*e.step);
  json["memory"] = {{"balls", e.memory.balls}, {"contacts", e.memory.contacts}, {"dense_packing", e.memory.dense}};
  json["stages"] = Json::array();
  for (const auto& stage : e.stages) {
    Json one{{"name", stage.name}};
    if (stage.cycles) one["cycles"] = *stage.cycles;
    if (stage.cycles) one["at_most"] = stage.at_most;
    json["stages"].push_back(one);
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace scree::core
