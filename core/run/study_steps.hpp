#pragma once
#include <string>
#include <vector>

#include "core/plugin/catalogue.hpp"
#include "core/scene/scene.hpp"

namespace scree::core {

/// What a run of a study changes in the scene.
struct StudyChange {
  double step = 0;      ///< s; 0: automatic, unless `own`
  bool own = false;     ///< the scene's own step
  bool unsafe = false;  ///< the step may be above the stable limit
  std::vector<std::pair<std::string, std::string>> set;
};

/// The scene as a study runs it: with the change, without records and saved states, and with lengths that were given in
/// cycles turned into the time of that many cycles of `cycle_length` seconds, so that all runs stand for the same time.
/// Throws as the reader does, and Refusal (exit 3) for a scene that runs no cycle or sets its step itself.
Scene changed_scene(const ReadOptions& base, Catalogue& catalogue, const StudyChange& change, double cycle_length);

/// The largest step up to `step` of which the lengths of all stages are whole multiples, so that no run ends up to half
/// a step early or late; `step` itself where the lengths have no common measure of at least four steps.
double aligned_step(const Scene& scene, double step);

/// The time that the stages run, s. What a test ends counts with the latest end it may have, if that is a time: cycles
/// given there are a guard and say little. `cycle_length`: what a cycle counts elsewhere, s.
double length_of(const Scene& scene, double cycle_length);

/// Ends the scene after `time` seconds of its stages: what comes later is taken out.
void cut_after(Scene& scene, double time);

/// The first action that runs cycles.
const RunAction& first_run(const Scene& scene);

}  // namespace scree::core
