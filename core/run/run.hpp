#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/isa.hpp"
#include "core/plugin/catalogue.hpp"
#include "core/run/summary.hpp"
#include "core/scene/scene.hpp"

namespace scree::core {

class Simulation;

/// What the command line decides about a run. Nothing here changes the trajectory.
struct RunOptions {
  std::string output;    ///< folder; "": the scene's name with .out
  bool restart = false;  ///< an unfinished earlier run may be moved away
  bool quiet = false, colour = true;
  unsigned threads = 0;  ///< 0: as many as cores, but not more than blocks of balls
  Isa isa = detect_isa();
  std::optional<uint64_t> cycles;    ///< stop after this many cycles of this call
  std::string stage;                 ///< stop after this stage; "": run all
  std::string from;                  ///< a saved state to begin from instead of the scene's own start
  double time_limit = 0;             ///< s of wall time, 0: none; then exit 75, resumable
  double patience = 0;               ///< s that a cycle may take at least before it counts as endless; 0: a minute
  bool allow_plugin_change = false;  ///< resume although a plug-in is not the one that was saved with
  std::function<void(Simulation&)> at_end;    ///< sees the simulation when all stages are over
  std::function<void(Simulation&)> at_cycle;  ///< sees it when a cycle has its forces, maybe twice; reads only
  std::vector<std::string> include_dirs;      ///< resume: where the scene finds files besides its own folder
};

/// What a run left behind, for the terminal.
struct RunResult {
  Exit code = Exit::done;
  Summary summary;
  std::string folder;
  double cycle_seconds = 0;  ///< of wall time, of the cycles alone
};

/// A scene brought to where its stages begin: set up, or loaded from the state that it starts from.
std::unique_ptr<Simulation> begin_scene(Scene scene, Catalogue& catalogue, const RunOptions& options);

/// Runs a scene into its output folder. Refusals before the folder exists are thrown; later ones end in the summary
/// and in the result's code.
RunResult run_scene(Scene scene, Catalogue& catalogue, const RunOptions& options);

/// Goes on with a run that was interrupted, from its last checkpoint. `previous`: from the one before.
RunResult resume_run(const std::string& folder, Catalogue& catalogue, const RunOptions& options, bool previous);

}  // namespace scree::core
