#include "core/run/study.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "core/base/log.hpp"
#include "core/cli/command.hpp"
#include "core/cli/flags.hpp"
#include "core/cli/output.hpp"
#include "core/run/signals.hpp"

namespace scree::core {

namespace {

// Values may be lists or quoted texts: only commas outside of those part them.
std::vector<std::string> parted(const std::string& text) {
  std::vector<std::string> out(1);
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{' || c == '(') {
      ++depth;
    } else if (c == ']' || c == '}' || c == ')') {
      --depth;
    }
    if (c == ',' && depth == 0 && quote == 0)
      out.emplace_back();
    else
      out.back() += c;
  }
  return out;
}

Variation variation(const std::string& text) {
  const std::size_t equals = text.find('=');
  Variation out;
  if (equals != std::string::npos) out.values = parted(text.substr(equals + 1));
  out.key = text.substr(0, equals);
  const bool empty = std::any_of(out.values.begin(), out.values.end(), [](const std::string& v) { return v.empty(); });
  if (out.key.empty() || out.values.empty() || empty)
    throw Refusal(Exit::usage, "--vary " + text +
                                   ": write it as --vary key=value,value, as in --vary "
                                   "processes.damping.factor=0.35,0.7");
  if (out.key == "timestep")
    throw Refusal(Exit::usage,
                  "--vary " + text + ": the timestep is what a study varies anyhow; --rungs says how often");
  return out;
}

struct StudyFlags {
  CommonFlags common;
  SceneFlags scene;
  std::string threads, isa, patience, output;
  unsigned rungs = 9, repeats = 3, seeds = 0;
  bool quick = false;
  std::vector<std::string> vary, quantities;

  void declare(CLI::App& app) {
    scene.declare(app, true);
    app.add_option("-o,--output", output, "the output folder; by default NAME.study in the working directory")
        ->type_name("DIR");
    app.add_flag("--quick", quick,
                 "the energy balance alone, over 2 % of the scene, at three steps, each half of the one before");
    app.add_option("--rungs", rungs, "how many steps, each 1/sqrt(2) of the one before; by default 9")
        ->check(CLI::Range(2U, 40U))
        ->type_name("N");
    app.add_option("--repeats", repeats, "runs of each point, for the wall time; by default 3")
        ->check(CLI::Range(1U, 1000U))
        ->type_name("N");
    app.add_option("--seeds", seeds, "run each point with that many seeds and compare pairwise: for chaotic scenes")
        ->check(CLI::Range(2U, 10000U))
        ->type_name("N");
    app.add_option("--vary", vary, "also try other values of a key of the scene; may be repeated")
        ->type_name("KEY=VALUE,VALUE")
        ->allow_extra_args(false);
    app.add_option("--quantity", quantities, "a quantity to compare besides those of 'expect'; may be repeated")
        ->type_name("FORMULA")
        ->allow_extra_args(false);
    app.add_option("-j,--threads", threads, "threads; any number gives the same bits")->type_name("N");
    app.add_option("--isa", isa, "instruction set: baseline, v3 or v4; by default the best there is")
        ->type_name("NAME");
    app.add_option("--patience", patience, "what one cycle may take before it counts as endless; by default 60 s")
        ->type_name("TIME");
    common.declare(app);
  }

  StudyOptions options() const {
    StudyOptions out;
    out.read = scene.options();
    RunFlags run;
    run.threads = threads;
    run.isa = isa;
    run.patience = patience;
    out.run = run.options(common);
    out.folder = output;
    out.log = common.log_settings();
    out.quick = quick;
    out.rungs = rungs;
    out.repeats = repeats;
    out.seeds = seeds;
    for (const std::string& text : vary) out.vary.push_back(variation(text));
    out.quantities = quantities;
    out.note = [](const std::string& line) { log::info("{}", line); };
    return out;
  }
};

std::string result_text(const Study& study) {
  std::string out;
  for (const StudyNorm& norm : study.norms) {
    out += norm.name + ": ";
    out += norm.order ? fmt::format("order {:.2f}", *norm.order) : "no order";
    out += " (" + norm.fit + ")";
    if (norm.odd)
      out += fmt::format(
          ", expected {:g}{}: look for what is not smooth, a law that is wrong or a reference that is not exact",
          norm.least_order, norm.most_order > norm.least_order ? fmt::format(" to {:g}", norm.most_order) : "");
    out += "\n";
  }
  out += conclusion(study) + "\n";
  return out + "results in " + study.folder + " (study.md, study.csv" +
         (study.picture.empty() ? "" : ", " + study.picture) + ")\n";
}

}  // namespace

Deed declare_study(CLI::App& app) {
  auto flags = std::make_shared<StudyFlags>();
  flags->declare(app);
  return [flags] {
    flags->common.open_log();
    const StudyOptions options = flags->options();
    const auto catalogue = flags->common.catalogue();
    install_signal_handlers();
    const Study study = study_scene(options, *catalogue);
    if (study.code != Exit::done)
      log::info("stopped by a signal; the points that are finished are in {}", study.folder);
    print(result_text(study));
    return study.code;
  };
}

}  // namespace scree::core
