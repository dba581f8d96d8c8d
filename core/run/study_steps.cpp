#include "core/run/study_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace scree::core {

namespace {

// The common measure of two lengths, by Euclid's algorithm up to rounding; 0 where it is too small to matter.
double common_measure(double a, double b, double least) {
  while (b > 1e-9 * a) {
    if (b < least) return 0;
    const double whole = std::round(a / b);
    const double rest = std::fabs(a - whole * b);
    a = b;
    b = rest > 1e-9 * a ? rest : 0;
  }
  return a;
}

void check_stages(const Scene& scene) {
  for (const Stage& stage : scene.stages)
    for (const Action& action : stage.actions)
      if (const auto* set = std::get_if<SetAction>(&action.what);
          set != nullptr && set->target == SetAction::Target::timestep)
        throw Refusal(Exit::scene, action.place.text() + ": error: stage '" + stage.name +
                                       "' sets the timestep itself, and a study varies it: take this 'set' out");
  first_run(scene);
}

}  // namespace

const RunAction& first_run(const Scene& scene) {
  for (const Stage& stage : scene.stages)
    for (const Action& action : stage.actions)
      if (const auto* run = std::get_if<RunAction>(&action.what)) return *run;
  throw Refusal(Exit::scene, scene.file +
                                 ": error: no stage runs a cycle, so there is nothing to measure: add one, as in "
                                 "'stages: [{fall: [run: 1 s]}]'");
}

Scene changed_scene(const ReadOptions& base, Catalogue& catalogue, const StudyChange& change, double cycle_length) {
  ReadOptions read = base;
  if (!change.own) read.set.emplace_back("timestep", change.step > 0 ? fmt::format("{}", change.step) : "automatic");
  if (change.unsafe) read.set.emplace_back("unsafe", "true");
  read.set.insert(read.set.end(), change.set.begin(), change.set.end());
  Scene scene = read_scene(read, catalogue);
  check_stages(scene);
  scene.record.clear();
  for (Stage& stage : scene.stages) {
    std::erase_if(stage.actions, [](const Action& a) { return std::holds_alternative<SaveAction>(a.what); });
    for (Action& action : stage.actions)
      if (auto* run = std::get_if<RunAction>(&action.what); run != nullptr && run->length.cycles && cycle_length > 0) {
        const double time = static_cast<double>(*run->length.cycles) * cycle_length;
        run->length.time = run->length.time ? std::min(*run->length.time, time) : time;
        run->length.cycles.reset();
      }
  }
  return scene;
}

double length_of(const Scene& scene, double cycle_length) {
  double sum = 0;
  for (const Stage& stage : scene.stages)
    for (const Action& action : stage.actions)
      if (const auto* run = std::get_if<RunAction>(&action.what)) {
        if (run->length.time)
          sum += *run->length.time;
        else if (run->length.cycles && run->until.empty())
          sum += static_cast<double>(*run->length.cycles) * cycle_length;
      }
  return sum;
}

void cut_after(Scene& scene, double time) {
  for (std::size_t s = 0; s < scene.stages.size(); ++s) {
    auto& actions = scene.stages[s].actions;
    for (std::size_t a = 0; a < actions.size(); ++a) {
      auto* run = std::get_if<RunAction>(&actions[a].what);
      if (run == nullptr) continue;
      if (run->length.time && *run->length.time < time) {
        time -= *run->length.time;
        continue;
      }
      run->length.time = time;
      actions.erase(actions.begin() + static_cast<std::ptrdiff_t>(a) + 1, actions.end());
      scene.stages.erase(scene.stages.begin() + static_cast<std::ptrdiff_t>(s) + 1, scene.stages.end());
      return;
    }
  }
}

double aligned_step(const Scene& scene, double step) {
  double measure = 0;
  for (const Stage& stage : scene.stages)
    for (const Action& action : stage.actions) {
      const auto* run = std::get_if<RunAction>(&action.what);
      // With a test the length is only the latest end.
      if (run == nullptr || !run->length.time || !run->until.empty()) continue;
      measure = measure == 0 ? *run->length.time
                             : common_measure(std::max(measure, *run->length.time),
                                              std::min(measure, *run->length.time), 4 * step);
      if (measure == 0) return step;
    }
  return measure < 4 * step ? step : measure / std::ceil(measure / step * (1 - 1e-12));
}

}  // namespace scree::core
