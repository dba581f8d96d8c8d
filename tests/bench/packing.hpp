#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/run/simulation.hpp"

namespace scree::bench {

/// How a benchmark runs.
struct Setting {
  std::size_t balls = 4000;
  bool friction = true;
  unsigned threads = 1;
  int isa = 0;
  std::string model = "linear";  ///< a contact model with the properties of `linear`
  /// Another law with all its properties, as in a scene: "model: hertz_mindlin, shear: 1e4, ..."; "" for `model`.
  std::string law{};
  double bond_gap = 0;  ///< pairs up to this gap are bonded, in diameters; 0: none are
};

/// A dense packing in a periodic cell: a body-centred lattice with jittered places and radii (uniform within 8 %) that
/// came to rest under its own contact law: about six active contacts and nine neighbours within the skin per ball, as
/// in a random packing.
std::unique_ptr<core::Simulation> dense_packing(const Setting& setting, core::Catalogue& catalogue);

/// ns per ball-step over the given number of cycles, list rebuilds included: processor time on one thread, so that
/// other load on the machine does not count, elapsed time on several.
double measure(core::Simulation& simulation, std::size_t cycles);

double median(std::vector<double> values);

}  // namespace scree::bench
