#include "core/cli/flags.hpp"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "core/base/isa.hpp"
#include "core/base/log.hpp"
#include "core/scene/units.hpp"

namespace scree::core {

namespace {

namespace fs = std::filesystem;

uint64_t count_of(const std::string& flag, const std::string& text, uint64_t least, const std::string& what) {
  uint64_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count < least)
    throw Refusal(Exit::usage, flag + " wants a whole number of " + what + ", at least " + std::to_string(least) +
                                   ", not '" + text + "'");
  return count;
}

/// `90`, `30 min`, `2h`: a plain number is in seconds.
double seconds_of(const std::string& flag, const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  std::string unit(end, text.data() + text.size());
  unit.erase(0, unit.find_first_not_of(' '));
  std::optional<double> seconds;
  if (error == std::errc() && unit.empty()) seconds = value;
  if (error == std::errc() && !unit.empty() && units::known(unit)) seconds = units::convert(value, unit, "s");
  if (!seconds || !(*seconds > 0) || !std::isfinite(*seconds))
    throw Refusal(Exit::usage, flag + " wants a time above 0, as in '90 s' or '2 h', not '" + text + "'");
  return *seconds;
}

}  // namespace

void CommonFlags::declare(CLI::App& app) {
  app.add_option("--plugins", plugins, "look for plug-ins here first; may be repeated")
      ->type_name("DIR")
      ->allow_extra_args(false);
  app.add_flag("--quiet", quiet, "warnings and errors only on stderr");
  app.add_flag("-v,--verbose", verbose, "more of the log on stderr");
  app.add_flag("--no-color", no_color, "plain text");
}

log::Settings CommonFlags::log_settings() const {
  log::Settings settings;
  settings.quiet = quiet;
  settings.verbose = verbose;
  settings.colour = !no_color;
  return settings;
}

void CommonFlags::open_log() const { log::open(log_settings()); }

std::unique_ptr<Catalogue> CommonFlags::catalogue() const {
  auto out = std::make_unique<Catalogue>(SearchPath::standard({plugins.begin(), plugins.end()}));
  for (const std::string& warning : out->warnings()) log::write(log::Level::warning, warning);
  out->warn = [](const std::string& warning) { log::write(log::Level::warning, warning); };
  return out;
}

std::vector<std::string> installed_configs() {
  const std::string data = data_folder();
  if (data.empty() || !fs::is_directory(data + "/configs")) return {};
  return {data + "/configs"};
}

void SceneFlags::declare(CLI::App& app, bool with_file) {
  if (with_file) app.add_option("SCENE", file, "the scene, a YAML file")->required()->type_name("");
  app.add_option("--set", set, "replace a value of the scene, as in --set vars.side=\"100 mm\"; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

ReadOptions SceneFlags::options() const {
  ReadOptions options;
  options.file = file;
  for (const std::string& text : set) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Refusal(Exit::usage, "--set " + text + ": write it as --set key=value, as in --set vars.side=\"100 mm\"");
    options.set.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  options.include_dirs = installed_configs();
  return options;
}

Scene SceneFlags::read(Catalogue& catalogue) const { return read_scene(options(), catalogue); }

void RunFlags::declare(CLI::App& app) {
  app.add_option("-j,--threads", threads, "threads; any number gives the same bits")->type_name("N");
  app.add_option("--isa", isa, "instruction set: baseline, v3 or v4; by default the best there is")->type_name("NAME");
  app.add_option("-n,--cycles", cycles, "stop after that many cycles")->type_name("CYCLES");
  app.add_option("--time-limit", time_limit, "stop after this wall time, as in 2h, resumable: exit code 75")
      ->type_name("TIME");
  app.add_option("--patience", patience, "what one cycle may take before it counts as endless; by default 60 s")
      ->type_name("TIME");
}

void RunFlags::declare_beginning(CLI::App& app) {
  app.add_option("-o,--output", output, "the output folder; by default NAME.out in the working directory")
      ->type_name("DIR");
  app.add_option("--stage", stage, "stop after this stage")->type_name("NAME");
  app.add_option("--from", from, "begin from a saved state")->type_name("STATE");
  app.add_flag("--restart", restart, "move an unfinished earlier run away instead of refusing");
}

RunOptions RunFlags::options(const CommonFlags& common) const {
  RunOptions out;
  out.output = output;
  out.restart = restart;
  out.quiet = common.quiet;
  out.colour = !common.no_color;
  if (!threads.empty()) {
    const uint64_t wanted = count_of("-j", threads, 1, "threads");
    if (wanted > 1024) throw Refusal(Exit::usage, "-j " + threads + ": at most 1024 threads");
    out.threads = static_cast<unsigned>(wanted);
  }
  if (!isa.empty()) out.isa = parse_isa(isa);
  if (!cycles.empty()) out.cycles = count_of("-n", cycles, 1, "cycles");
  if (!time_limit.empty()) out.time_limit = seconds_of("--time-limit", time_limit);
  if (!patience.empty()) out.patience = seconds_of("--patience", patience);
  out.stage = stage;
  out.from = from;
  return out;
}

void declare_json(CLI::App& app, bool& json, const std::string& what) {
  app.add_flag("--json", json, what + " as JSON on stdout");
}

std::string program_prefix() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? "" : program.parent_path().parent_path().string();
}

std::string data_folder() {
  std::error_code error;
  const fs::path folder = fs::path(program_prefix()) / SCREE_DATA_DIR;
  return fs::is_directory(folder, error) ? folder.string() : "";
}

}  // namespace scree::core
