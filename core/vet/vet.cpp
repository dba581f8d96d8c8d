#include "core/vet/vet.hpp"

#include <chrono>
#include <cstring>
#include <set>

#include "core/base/log.hpp"
#include "core/base/nearest.hpp"
#include "core/plugin/library.hpp"
#include "core/vet/isolated.hpp"

namespace scree::core::vet {

namespace {

namespace fs = std::filesystem;
using Name = std::pair<Kind, std::string>;
constexpr Kind kinds[] = {Kind::contact_model, Kind::wall, Kind::generator, Kind::process, Kind::writer};

/// What a check comes to when its code returns or throws.
template <class Run>
Outcome outcome_of(Run run) {
  try {
    return run();
  } catch (const Skipped& why) {
    return {Verdict::skip, why.what(), "", NAN, NAN};
  } catch (const Failed& failure) {
    return failed(failure.what(), failure.next);
  } catch (const Refusal& refusal) {
    return failed(refusal.what(), "");
  } catch (const std::exception& error) {
    return failed(std::string("an exception came through the boundary: ") + error.what(),
                  "catch it in the plug-in; the headers of the SDK do");
  } catch (...) {
    return failed("something that is no std::exception came through the boundary",
                  "catch it in the plug-in; the headers of the SDK do");
  }
}

std::string signal_text(int number) {
  const char* name = sigabbrev_np(number);
  return name != nullptr ? std::string("SIG") + name : "signal " + std::to_string(number);
}

/// What a child that did not return its outcome comes to.
Outcome outcome_of(const ChildEnd& end, double limit) {
  if (end.finished) return Outcome::unpacked(end.bytes);
  if (end.timed_out)
    return failed(fmt::format("did not come to an end within {:g} s", limit),
                  "look for a loop that runs until something converges; --limit gives it more time");
  if (end.signal != 0)
    return failed("crashed: " + signal_text(end.signal),
                  "run scree vet with --check under a debugger, or with a build "
                  "of the plug-in that has sanitizers");
  return failed(fmt::format("ended the process with exit code {}", end.code),
                "a plug-in refuses by throwing, never by exit()");
}

Outcome checked(const Check& check, const fs::path& file, const Name* name, double limit) {
  const ChildEnd end = isolated(
      [&] {
        return outcome_of([&] {
                 Subject subject{file, nullptr};
                 Loaded loaded;
                 if (name != nullptr) {
                   loaded = load_component(name->first, name->second, file);
                   subject.component = &loaded.component;
                 }
                 return check.run(subject);
               })
            .packed();
      },
      limit);
  return outcome_of(end, limit);
}

/// Asked in a child as well, because it opens the library. Empty when the library does not open, which the checks of
/// the library have told.
std::vector<Name> names_in(const fs::path& file, double limit) {
  const ChildEnd end = isolated(
      [&] {
        std::string text;
        try {
          for (const auto& [kind, name] : list_components(file))
            text += std::to_string(static_cast<uint32_t>(kind)) + name + '\n';
        } catch (...) {
          text.clear();
        }
        return text;
      },
      limit);
  std::vector<Name> names;
  for (std::size_t at = 0; at < end.bytes.size();) {
    const std::size_t stop = end.bytes.find('\n', at);
    names.emplace_back(static_cast<Kind>(end.bytes[at] - '0'), end.bytes.substr(at + 1, stop - at - 1));
    at = stop + 1;
  }
  return names;
}

void require_known(const std::string& only) {
  if (only.empty()) return;
  std::vector<std::string> names;
  for (const auto& [name, shows] : all_checks()) {
    if (name == only) return;
    names.push_back(name);
  }
  const std::string near = nearest_name(only, names);
  throw Refusal(Exit::usage, "there is no check '" + only + "'" +
                                 (near.empty() ? "" : "; did you mean '" + near + "'?") +
                                 "  (scree vet --list names them)");
}

}  // namespace

std::vector<std::pair<std::string, std::string>> all_checks() {
  std::vector<std::pair<std::string, std::string>> list;
  std::set<std::string> seen;
  const auto add = [&](const Check& check) {
    if (seen.insert(std::string(check.name) + check.shows).second) list.emplace_back(check.name, check.shows);
  };
  for (const Check& check : library_checks()) add(check);
  for (const Kind kind : kinds)
    for (const Check& check : component_checks(kind)) add(check);
  return list;
}

std::vector<Row> vet(const fs::path& given, const Options& options, const std::function<void(const Row&)>& done) {
  require_known(options.only);
  const fs::path file = fs::absolute(given);
  std::vector<Row> rows;
  const auto make = [&](const Check& check, const std::string& component, const Name* name) {
    if (!options.only.empty() && options.only != check.name) return;
    const auto start = std::chrono::steady_clock::now();
    Row row{component, check.name, check.shows, checked(check, file, name, options.limit), 0};
    row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    done(row);
    rows.push_back(std::move(row));
  };
  if (options.component.empty())
    for (const Check& check : library_checks()) make(check, "library", nullptr);
  std::vector<std::string> held;
  bool found = options.component.empty();
  for (const Name& name : names_in(file, options.limit)) {
    held.push_back(name.second);
    if (!options.component.empty() && options.component != name.second) continue;
    found = true;
    for (const Check& check : component_checks(name.first))
      make(check, std::string(kind_name(name.first)) + " " + name.second, &name);
  }
  if (!found) {
    const std::string near = nearest_name(options.component, held);
    throw Refusal(Exit::usage, file.string() + " holds no component '" + options.component + "'" +
                                   (near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
  return rows;
}

}  // namespace scree::core::vet
