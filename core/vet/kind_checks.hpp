#pragma once
#include "core/vet/check.hpp"

/// The checks of walls, processes, generators and writers. Each is a row of component_checks.
namespace scree::core::vet {

// wall_geometry.cpp
Outcome wall_touches_sound(const Subject& subject);
Outcome wall_slope(const Subject& subject);
Outcome wall_reach(const Subject& subject);
Outcome wall_flat(const Subject& subject);
Outcome wall_outline(const Subject& subject);
// wall_calls.cpp
Outcome wall_arrays(const Subject& subject);
Outcome wall_overflow(const Subject& subject);
Outcome wall_extremes(const Subject& subject);
Outcome wall_allocates(const Subject& subject);
Outcome wall_global_state(const Subject& subject);
Outcome wall_float_mode(const Subject& subject);
// process.cpp
Outcome process_bits(const Subject& subject);
Outcome process_columns(const Subject& subject);
Outcome process_extremes(const Subject& subject);
Outcome process_allocates(const Subject& subject);
Outcome process_global_state(const Subject& subject);
Outcome process_float_mode(const Subject& subject);
Outcome process_step(const Subject& subject);
Outcome process_damping(const Subject& subject);
Outcome process_speed(const Subject& subject);
// generator.cpp
Outcome generator_repeatable(const Subject& subject);
Outcome generator_balls_sound(const Subject& subject);
Outcome generator_stops(const Subject& subject);
// writer.cpp
Outcome writer_frames(const Subject& subject);
Outcome writer_repeatable(const Subject& subject);
Outcome writer_full_disk(const Subject& subject);
Outcome writer_resume(const Subject& subject);

}  // namespace scree::core::vet
