#pragma once
#include <string>
#include <vector>

#include "core/run/study.hpp"

namespace scree::core {

/// How long two runs of the same scene can be compared ball by ball.
struct Horizon {
  double time = 0;            ///< s
  std::string reason;         ///< what ends it
  double usual_step = 0;      ///< s, the least sqrt(m/k) over balls and axes that was met; 0: nothing touched
  double first_step = 0;      ///< s, the step of the first cycle
  bool dashpots = false;      ///< contacts have dashpots, or balls are damped
  bool impacts = false;       ///< contacts began
  bool tangential = false;    ///< a rule has a tangential part, so contacts can slide
  double radius = 0;          ///< m, the median
  std::vector<double> mass;   ///< in order of ids, kg
  std::vector<double> start;  ///< positions before the first cycle, in order of ids, m
};

/// Runs the scene beside a twin whose balls are shifted by 1e-10 of their radius: the horizon is the time of three
/// collisions for each ball, or a quarter of the time at which the twin is 1e-3 of a radius away, or `longest`,
/// whichever comes first. The scene has its own step or the automatic one.
Horizon find_horizon(const Scene& scene, Scene twin, Catalogue& catalogue, const RunOptions& options, double longest);

/// Where a short run ended.
struct Flight {
  std::vector<double> positions;  ///< in order of ids, m; empty when the run failed
  std::vector<double> turned;     ///< unit quaternions w x y z, in order of ids; empty where nothing turns balls
};

/// The scene from its first cycle over a time that its fixed step divides. `run` says how it went.
Flight fly(Scene scene, Catalogue& catalogue, const RunOptions& options, uint64_t cycles, StudyRun& run);

}  // namespace scree::core
