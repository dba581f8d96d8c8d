#include "core/cli/command.hpp"

namespace scree::core {

const std::vector<Command>& commands() {
  static const std::vector<Command> all = {
      {"run", "SCENE", "run a scene", declare_run},
      {"resume", "FOLDER", "go on with a run that was cut short, bit for bit", declare_resume},
      {"check", "SCENE", "the checks of a run, up to its first cycle", declare_check},
      {"explain", "SCENE", "what the run will open, store, do and leave out, and why", declare_explain},
      {"study", "SCENE", "error against run time, over a ladder of steps", declare_study},
      {"list", "[KIND]", "the plug-ins that are found, and where", declare_list},
      {"show", "NAME", "one plug-in: its keys, units, ranges, defaults", declare_show},
      {"new", "KIND NAME", "a folder with a plug-in of your own that builds and passes its test", declare_new},
      {"vet", "LIB", "conformance checks of a plug-in library, for its author", declare_vet},
      {"schema", "", "the JSON Schema of scenes, for editors", declare_schema},
      {"demo", "", "a real job: a mould filled with stones", declare_demo}};
  return all;
}

}  // namespace scree::core
