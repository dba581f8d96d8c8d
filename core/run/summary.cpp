#include "core/run/summary.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/file.hpp"
#include "core/base/hash.hpp"

namespace scree::core {

namespace {

using Json = nlohmann::ordered_json;

Json number(double x) {
  if (std::isnan(x)) return "NaN";
  if (std::isinf(x)) return x > 0 ? "Infinity" : "-Infinity";
  return x;
}

void put(Json& json, const char* key, const std::optional<double>& x) {
  if (x) json[key] = number(*x);
}
void put(Json& json, const char* key, const std::optional<uint64_t>& x) {
  if (x) json[key] = *x;
}
void put(Json& json, const char* key, const std::string& text) {
  if (!text.empty()) json[key] = text;
}

Json named(const Summary::Named& pairs) {
  Json json = Json::object();
  for (const auto& [name, value] : pairs) json[name] = number(value);
  return json;
}

Json expectation(const ExpectationResult& e) {
  Json json = Json::object();
  put(json, "text", e.text);
  put(json, "quantity", e.quantity);
  json["value"] = number(e.value);
  json["passed"] = e.passed;
  put(json, "low", e.low);
  put(json, "high", e.high);
  put(json, "equals", e.equals);
  put(json, "tolerance", e.tolerance);
  put(json, "difference", e.difference);
  put(json, "source", e.source);
  return json;
}

Json plugin(const Summary::Plugin& p) {
  Json json = Json::object();
  put(json, "kind", p.kind);
  put(json, "name", p.name);
  put(json, "version", p.version);
  put(json, "sha256", p.sha256);
  put(json, "shadowed", p.shadowed);
  return json;
}

void put_measures(Json& json, const Summary& s) {
  put(json, "cycles", s.cycles);
  put(json, "model_time", s.model_time);
  put(json, "wall_time", s.wall_time);
  put(json, "ball_steps_per_second", s.ball_steps_per_second);
  put(json, "peak_memory_bytes", s.peak_memory_bytes);
  put(json, "balls", s.balls);
  put(json, "contacts", s.contacts);
  if (s.timestep) {
    Json& step = json["timestep"] = Json::object();
    step["used"] = number(s.timestep->used);
    put(step, "certified", s.timestep->certified);
    put(step, "governed_by", s.timestep->governed_by);
  }
  if (s.energy) {
    Json& energy = json["energy"] = Json::object();
    put(energy, "residual", s.energy->residual);
    if (!s.energy->terms.empty()) energy["terms"] = named(s.energy->terms);
  }
  if (!s.quantities.empty()) json["quantities"] = named(s.quantities);
}

}  // namespace

std::string status_word(Exit code) {
  switch (code) {
    case Exit::done:
      return "done";
    case Exit::internal:
      return "internal_error";
    case Exit::usage:
      return "usage_error";
    case Exit::scene:
      return "scene_invalid";
    case Exit::plugin:
      return "plugin_refused";
    case Exit::numerical:
      return "numerical_stop";
    case Exit::io:
      return "io_failure";
    case Exit::expectation:
      return "expectation_failed";
    case Exit::memory:
      return "out_of_memory";
    case Exit::folder_in_use:
      return "folder_in_use";
    case Exit::time_limit:
      return "time_limit";
    case Exit::interrupted:
      return "interrupted";
    case Exit::terminated:
      return "terminated";
  }
  return "internal_error";
}

std::string to_json(const Summary& s) {
  Json json = Json::object();
  json["schema"] = summary_schema;
  json["status"] = status_word(s.exit_code);
  json["exit_code"] = static_cast<int>(s.exit_code);
  put(json, "message", s.message);
  put(json, "version", s.program_version);
  put(json, "title", s.title);
  put(json, "scene", s.scene);
  put(json, "seed", s.seed);
  put(json, "threads", s.threads);
  put(json, "isa", s.isa);
  put_measures(json, s);
  for (const auto& e : s.expectations) json["expectations"].push_back(expectation(e));
  if (s.error) {
    Json& error = json["error"] = Json::object();
    put(error, "estimate", s.error->estimate);
    put(error, "reference", s.error->reference);
    put(error, "method", s.error->method);
  }
  if (s.state_hash) json["state_hash"] = std::string(std::string_view(hash_text(*s.state_hash)));
  for (const auto& text : s.left_out) json["left_out"].push_back(text);
  for (const auto& p : s.plugins) json["plugins"].push_back(plugin(p));
  // Names of files need not be UTF-8; such bytes become U+FFFD instead of ending the run.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

int write_summary(const std::string& path, const Summary& summary) { return write_atomically(path, to_json(summary)); }

std::optional<uint64_t> peak_memory_bytes() {
  // Not getrusage: its maximum survives exec and then speaks of the shell that started the run.
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (!line.starts_with("VmHWM:")) continue;
    const size_t digit = line.find_first_of("0123456789");
    uint64_t kilobytes = 0;
    if (digit != std::string::npos &&
        std::from_chars(line.data() + digit, line.data() + line.size(), kilobytes).ec == std::errc())
      return kilobytes * 1024;
  }
  return std::nullopt;
}

}  // namespace scree::core
