#include "core/vet/vet.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/base/log.hpp"
#include "core/cli/command.hpp"
#include "core/cli/flags.hpp"
#include "core/cli/kinds.hpp"
#include "core/cli/output.hpp"

namespace scree::core {

namespace {

using vet::Row;
using vet::Verdict;

/// A path, or the name of an installed plug-in. Finding one by name opens nothing.
std::filesystem::path file_of(const std::string& word, const std::optional<Kind>& kind, const Catalogue& catalogue) {
  if (word.find('/') != std::string::npos || std::filesystem::exists(word)) {
    if (!std::filesystem::exists(word))
      throw Refusal(Exit::plugin, word + ": there is no such file: give the library that was built, a .so file");
    return word;
  }
  const Found* first = nullptr;
  for (const Found& found : catalogue.found()) {
    if (found.name != word || found.shadowed || (kind && found.kind != *kind)) continue;
    if (first != nullptr)
      throw Refusal(Exit::usage, "'" + word + "' is the name of " + first->file.string() + " and of " +
                                     found.file.string() + ": give the path of the one you mean");
    first = &found;
  }
  if (first == nullptr)
    throw Refusal(Exit::plugin, "there is no file and no plug-in '" + word +
                                    "': give the library that was built, a .so file (scree list names those that are "
                                    "installed)");
  return first->file;
}

double seconds(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value > 0) || value > 1e6)
    throw Refusal(Exit::usage, "--limit wants the seconds that one check may take, above 0, not '" + text + "'");
  return value;
}

std::string figure_text(const vet::Outcome& outcome) {
  if (std::isnan(outcome.figure)) return "";
  if (std::isnan(outcome.tolerance)) return fmt::format("{:.3g}", outcome.figure);
  return fmt::format("{:.3g} of {:.3g}", outcome.figure, outcome.tolerance);
}

/// One line, and on failure what was seen and what to do about it below.
std::string line_of(const Row& row) {
  const vet::Outcome& o = row.outcome;
  const bool wrong = o.verdict == Verdict::fail || o.verdict == Verdict::note;
  std::string out =
      fmt::format("  {:<4}  {:<21}  {:<17}  {}", verdict_name(o.verdict), row.check, figure_text(o), row.shows);
  if (!wrong && !o.found.empty()) out += (o.verdict == Verdict::skip ? ": " : ". ") + o.found;
  out += "\n";
  if (wrong) {
    out += "        " + o.found + "\n";
    if (!o.next.empty()) out += "        next: " + o.next + "\n";
  }
  return out;
}

std::size_t count(const std::vector<Row>& rows, Verdict verdict) {
  return static_cast<std::size_t>(
      std::count_if(rows.begin(), rows.end(), [&](const Row& row) { return row.outcome.verdict == verdict; }));
}

std::string closing(const std::vector<Row>& rows) {
  const std::size_t failures = count(rows, Verdict::fail);
  return fmt::format("{} checks: {} passed, {} failed, {} to note, {} measured, {} skipped\n", rows.size(),
                     count(rows, Verdict::pass), failures, count(rows, Verdict::note), count(rows, Verdict::info),
                     count(rows, Verdict::skip));
}

std::string json_of(const std::filesystem::path& file, const std::vector<Row>& rows) {
  using Json = nlohmann::ordered_json;
  const char* const words[] = {"pass", "note", "info", "skip", "fail"};
  Json list = Json::array();
  for (const Row& row : rows) {
    Json one{{"component", row.component},
             {"check", row.check},
             {"verdict", words[static_cast<std::size_t>(row.outcome.verdict)]},
             {"shows", row.shows},
             {"seconds", row.seconds}};
    if (std::isfinite(row.outcome.figure)) one["figure"] = row.outcome.figure;
    if (std::isinf(row.outcome.figure)) one["figure"] = "Infinity";
    if (!std::isnan(row.outcome.tolerance)) one["tolerance"] = row.outcome.tolerance;
    if (!row.outcome.found.empty()) one["found"] = row.outcome.found;
    if (!row.outcome.next.empty()) one["next"] = row.outcome.next;
    list.push_back(std::move(one));
  }
  const Json out{{"library", file.string()},
                 {"passed", count(rows, Verdict::fail) == 0},
                 {"failures", count(rows, Verdict::fail)},
                 {"checks", std::move(list)}};
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string list_text() {
  std::string out;
  for (const auto& [name, shows] : vet::all_checks()) out += fmt::format("{:<21}  {}\n", name, shows);
  return out;
}

struct Flags {
  CommonFlags common;
  std::string library, kind, component, only, limit;
  bool json = false, list = false;
};

Exit run_vet(const Flags& flags) {
  flags.common.open_log();
  if (flags.list) {
    print(list_text());
    return Exit::done;
  }
  if (flags.library.empty()) throw Refusal(Exit::usage, "LIB is required  (scree vet -h lists operands and flags)");
  vet::Options options;
  options.only = flags.only;
  options.component = flags.component;
  if (!flags.limit.empty()) options.limit = seconds(flags.limit);
  const std::optional<Kind> kind = parse_kind(flags.kind);
  const std::filesystem::path file = file_of(flags.library, kind, *flags.common.catalogue());
  std::string component;
  const std::vector<Row> rows = vet::vet(file, options, [&](const Row& row) {
    if (flags.json) return;
    if (row.component != component) print(row.component + "\n");
    component = row.component;
    print(line_of(row));
  });
  print(flags.json ? json_of(file, rows) : closing(rows));
  return count(rows, Verdict::fail) == 0 ? Exit::done : Exit::plugin;
}

}  // namespace

Deed declare_vet(CLI::App& app) {
  auto flags = std::make_shared<Flags>();
  app.add_option("LIB", flags->library, "the library, a .so file, or the name of an installed plug-in")->type_name("");
  app.add_option("--kind", flags->kind, "which kind, where a name is of several: " + kind_words())->type_name("KIND");
  app.add_option("--component", flags->component, "only this component of the library")->type_name("NAME");
  app.add_option("--check", flags->only, "make this check only")->type_name("NAME");
  app.add_option("--limit", flags->limit, "seconds that one check may take; 30 by default")->type_name("SECONDS");
  app.add_flag("--list", flags->list, "name all checks and end");
  declare_json(app, flags->json, "the result");
  flags->common.declare(app);
  return [flags] { return run_vet(*flags); };
}

}  // namespace scree::core
