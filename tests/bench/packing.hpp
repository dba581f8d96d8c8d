#pragma once
#include <cstddef>
#include <memory>
#include <string>

#include "core/run/simulation.hpp"

namespace scree::bench {

/// How a benchmark runs.
struct Setting {
  std::size_t balls = 4000;
  bool friction = true;
  unsigned threads = 1;
  int isa = 0;
};

/// A dense packing in a periodic cell: a face-centred lattice with jittered places and radii (uniform within 8 %),
/// about six active contacts per ball, linear contacts. It has settled for some cycles, so lists and contacts are those
/// of a packing at rest.
std::unique_ptr<core::Simulation> dense_packing(const Setting& setting, core::Catalogue& catalogue);

/// ns per ball-step over the given number of cycles, list rebuilds included.
double measure(core::Simulation& simulation, std::size_t cycles);

}  // namespace scree::bench
