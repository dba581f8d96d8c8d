#include <CLI/CLI.hpp>
#include <memory>

#include "core/cli/command.hpp"
#include "core/cli/flags.hpp"
#include "core/cli/report.hpp"
#include "core/run/run.hpp"
#include "core/run/signals.hpp"

namespace scree::core {

Deed declare_resume(CLI::App& app) {
  struct Flags {
    CommonFlags common;
    RunFlags run;
    std::string folder, from = "latest";
    bool changed = false, json = false;
  };
  auto flags = std::make_shared<Flags>();
  app.add_option("FOLDER", flags->folder, "the output folder of the run")->required()->type_name("");
  flags->run.declare(app);
  app.add_option("--from", flags->from, "which checkpoint: latest, or previous")->type_name("WHICH");
  app.add_flag("--allow-plugin-change", flags->changed, "go on although a plug-in is not the one that was saved with");
  declare_json(app, flags->json, "the summary");
  flags->common.declare(app);
  return [flags] {
    flags->common.open_log();
    if (flags->from != "latest" && flags->from != "previous")
      throw Refusal(Exit::usage, "--from " + flags->from + ": resume goes on from 'latest' or 'previous'");
    RunOptions options = flags->run.options(flags->common);
    options.allow_plugin_change = flags->changed;
    options.include_dirs = installed_configs();
    const auto catalogue = flags->common.catalogue();
    install_signal_handlers();
    return print_result(resume_run(flags->folder, *catalogue, options, flags->from == "previous"), flags->json);
  };
}

}  // namespace scree::core
