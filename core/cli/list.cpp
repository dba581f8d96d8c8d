#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/base/log.hpp"
#include "core/cli/command.hpp"
#include "core/cli/flags.hpp"
#include "core/cli/kinds.hpp"
#include "core/cli/output.hpp"

namespace scree::core {

namespace {

struct Entry {
  std::string kind, name, version, file, state, reason, doc;
};

Entry entry_of(const Found& found, Catalogue& catalogue) {
  Entry entry{kind_name(found.kind), found.name, "", found.file.string(), "", "", ""};
  if (found.shadowed) {
    entry.state = "shadowed";
    entry.reason = "a file of this name in a folder of --plugins wins";
    return entry;
  }
  try {
    const Component& component = catalogue.open(found.kind, found.name);
    entry.version = component.version;
    entry.doc = component.doc;
    entry.state = "ok";
  } catch (const Refusal& refusal) {
    entry.state = "refused";
    entry.reason = refusal.what();
  }
  return entry;
}

std::string text_of(const std::vector<Entry>& entries) {
  std::size_t kind = 0, name = 0, version = 0;
  for (const Entry& e : entries) {
    kind = std::max(kind, e.kind.size());
    name = std::max(name, e.name.size());
    version = std::max(version, e.version.size());
  }
  std::string out;
  for (const Entry& e : entries) {
    out += fmt::format("{:<{}}  {:<{}}  {:<{}}  {}", e.kind, kind, e.name, name, e.version, version, e.file);
    if (e.state != "ok") out += "  " + e.state + ": " + e.reason;
    out += "\n";
  }
  return out;
}

std::string json_of(const std::vector<Entry>& entries) {
  using Json = nlohmann::ordered_json;
  Json out = Json::array();
  for (const Entry& e : entries) {
    Json one{{"kind", e.kind}, {"name", e.name}, {"library", e.file}, {"state", e.state}};
    if (!e.version.empty()) one["version"] = e.version;
    if (!e.doc.empty()) one["doc"] = e.doc;
    if (!e.reason.empty()) one["reason"] = e.reason;
    out.push_back(std::move(one));
  }
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

Deed declare_list(CLI::App& app) {
  struct Flags {
    CommonFlags common;
    std::string kind;
    bool json = false;
  };
  auto flags = std::make_shared<Flags>();
  app.add_option("KIND", flags->kind, "only this kind: " + kind_words())->type_name("");
  declare_json(app, flags->json, "the list");
  flags->common.declare(app);
  return [flags] {
    flags->common.open_log();
    const std::optional<Kind> wanted = parse_kind(flags->kind);
    const auto catalogue = flags->common.catalogue();
    std::vector<Found> found = catalogue->found();
    std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
      return a.kind != b.kind ? a.kind < b.kind : a.name < b.name;
    });
    std::vector<Entry> entries;
    for (const Found& file : found)
      if (!wanted || file.kind == *wanted) entries.push_back(entry_of(file, *catalogue));
    if (entries.empty()) log::info("no plug-in is installed; give a folder with --plugins");
    print(flags->json ? json_of(entries) : text_of(entries));
    return Exit::done;
  };
}

}  // namespace scree::core
