#pragma once
#include <string>
#include <vector>

#include "core/run/archive.hpp"
#include "core/run/simulation.hpp"

namespace scree::core {

/// Everything of a run but its recorders: the scene as text, plug-ins' hashes, what edits made of the scene, how far
/// the stages have come, and the engine. Changes nothing, also while the forces of this time are there. [one thread]
void save_state(const Simulation& simulation, ArchiveWriter& out);

/// The scene that a state was saved from. First opens the same plug-ins; one that changed is refused (Exit::plugin)
/// unless `allow_plugin_change`, and then warned of in the scene's warnings.
Scene saved_scene(const ArchiveReader& in, Catalogue& catalogue, bool allow_plugin_change = false,
                  const std::vector<std::string>& include_dirs = {});

/// Into a fresh simulation of `saved_scene`, of any thread count and instruction set, without set_up(). The run then
/// goes on with the same bits as if it had never stopped; do not call prepare() in between. Values that cannot be used
/// are refused (Exit::io) with the section named.
void load_state(Simulation& simulation, const ArchiveReader& in);

/// `start: {state}`: balls, groups, clock and contact memory of a saved state, into a fresh simulation of another
/// scene, in place of set_up(); the scene's own balls come in addition. Walls, rules and processes are the scene's. A
/// wall of the same name stands where it had come to. A contact goes on where its rule has the same name, the same
/// model and the same state words, and starts fresh elsewhere. Cycle and time go on from the state, and so do
/// velocities of the half step before. Ends with prepare().
void load_specimen(Simulation& simulation, const ArchiveReader& in);

}  // namespace scree::core
