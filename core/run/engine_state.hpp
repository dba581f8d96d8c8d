#pragma once
#include "core/cycle/engine.hpp"
#include "core/run/archive.hpp"

namespace scree::core {

/// Everything of the engine that a continued run needs for the same bits; also while the forces of this time are there.
/// Not the scene's part: cell, geometry of walls, laws of rules and objects of processes.
void save_engine(const Engine& engine, ArchiveWriter& out);

/// Into an engine of any thread count and instruction set whose cell, walls, rules and processes are set up and that
/// holds no balls. `groups`: how many there are. Calls prepare(), which must not be called again before the run goes
/// on: it would choose a new step.
void load_engine(Engine& engine, const ArchiveReader& in, std::size_t groups);

/// Names of processes with their saved words.
void load_processes(std::vector<Process>& processes, const ArchiveReader& in);
void load_clock(Clock& clock, const ArchiveReader& in);

}  // namespace scree::core
