#pragma once
#include "core/run/archive.hpp"
#include "core/run/simulation.hpp"

namespace scree::core {

/// The words of the scene as edits left them, in the order in which things were made: groups, walls, processes, ball
/// sets, rules.
void save_words(const Simulation& simulation, ArchiveWriter& out);

/// Groups, walls, ball sets and rules, into a fresh simulation.
void load_words(Simulation& simulation, const ArchiveReader& in);
/// Processes look at walls and balls when they are made, so these must stand already.
void load_process_words(Simulation& simulation, const ArchiveReader& in);

// Parts of load_words.
void load_groups(Simulation& simulation, const ArchiveReader& in);
void load_ball_sets(Simulation& simulation, const ArchiveReader& in);

}  // namespace scree::core
