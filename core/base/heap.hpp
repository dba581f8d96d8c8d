#pragma once

namespace scree::core {

/// Large arrays come straight from the system and go straight back when they are freed, so that the peak of a run is
/// what it holds and not what it once held. Call once, at start. [one thread]
void tune_heap();

/// Gives free memory back to the system, as after a set-up that held more than the run will. [any thread]
void return_free_memory();

}  // namespace scree::core
