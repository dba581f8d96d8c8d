#include "core/cli/report.hpp"

#include <algorithm>

#include "core/base/hash.hpp"
#include "core/base/log.hpp"
#include "core/cli/output.hpp"

namespace scree::core {

namespace {

std::string ending(const RunResult& result) {
  std::string word = status_word(result.code);
  std::replace(word.begin(), word.end(), '_', ' ');
  const Summary& s = result.summary;
  std::string out = word;
  if (s.cycles) out += fmt::format(" after {} cycles", *s.cycles);
  if (s.model_time) out += fmt::format(", {:.6g} s of model time", *s.model_time);
  if (s.wall_time) out += fmt::format(", {:.3g} s of wall time", *s.wall_time);
  return out + "\n";
}

std::string measures(const Summary& s) {
  std::string out;
  if (s.balls) out += fmt::format("balls      {}\n", *s.balls);
  if (s.contacts) out += fmt::format("contacts   {}\n", *s.contacts);
  if (s.timestep) {
    out += fmt::format("step       {:.6g} s", s.timestep->used);
    if (!s.timestep->governed_by.empty()) out += ", governed by " + s.timestep->governed_by;
    out += "\n";
  }
  if (s.ball_steps_per_second) out += fmt::format("speed      {:.3g} ball-steps/s\n", *s.ball_steps_per_second);
  if (s.peak_memory_bytes)
    out += fmt::format("memory     {:.3g} MB\n", static_cast<double>(*s.peak_memory_bytes) / 1e6);
  if (s.state_hash) out += fmt::format("hash       {}\n", std::string_view(hash_text(*s.state_hash)));
  return out;
}

std::string quantities(const Summary& s) {
  std::size_t width = 0;
  for (const auto& [name, value] : s.quantities) width = std::max(width, name.size());
  std::string out;
  for (const auto& [name, value] : s.quantities) out += fmt::format("{:<{}} = {:.8g}\n", name, width, value);
  return out;
}

std::string expectations(const Summary& s) {
  std::string out;
  for (const ExpectationResult& e : s.expectations) {
    out += fmt::format("{}  {}: {:.8g}", e.passed ? "passed" : "FAILED", e.text, e.value);
    if (e.difference) out += fmt::format(", difference {:.3g}", *e.difference);
    out += "\n";
  }
  return out;
}

}  // namespace

std::string report_text(const RunResult& result) {
  std::string out = ending(result) + measures(result.summary) + quantities(result.summary);
  out += expectations(result.summary);
  if (!result.folder.empty()) out += "results in " + result.folder + "\n";
  const bool resumable =
      result.code == Exit::time_limit || result.code == Exit::interrupted || result.code == Exit::terminated;
  if (resumable && !result.summary.message.empty()) out += result.summary.message + "\n";
  return out;
}

Exit print_result(const RunResult& result, bool json) {
  print(json ? to_json(result.summary) : report_text(result));
  return result.code;
}

}  // namespace scree::core
