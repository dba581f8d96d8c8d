#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/log.hpp"
#include "core/run/run.hpp"

namespace scree::core {

/// A key of the scene and the values it is tried at, besides the scene's own.
struct Variation {
  std::string key;
  std::vector<std::string> values;
};

struct StudyOptions {
  ReadOptions read;
  RunOptions run;
  std::string folder;  ///< "": the scene's name with .study
  bool quick = false;
  log::Settings log;     ///< what the terminal shows between runs
  unsigned rungs = 9;    ///< a quick study has 3
  unsigned repeats = 3;  ///< runs of each point, for the wall time; a quick study has 1
  unsigned seeds = 0;    ///< runs of each point with seeds of their own, 0: the scene's seed alone
  std::vector<Variation> vary;
  std::vector<std::string> quantities;  ///< besides those of `expect`
  /// A line for a person who waits.
  std::function<void(const std::string&)> note = [](const std::string&) {};
};

/// How one run of a study went.
struct StudyRun {
  Exit code = Exit::done;
  std::string message;
  uint64_t seed = 0, cycles = 0, ball_steps = 0, contact_updates = 0, state_hash = 0;
  double step = 0, model_time = 0;  ///< s
  double wall = 0;                  ///< s, of the cycles alone
  std::vector<double> values;       ///< of the quantities of the study, in order; empty unless it came to its end
  /// Cycle and energy residual as a share of what passed through; of the first run of a point only.
  std::vector<std::pair<double, double>> residual;
};

/// The same scene at one step, or with one key changed.
struct StudyPoint {
  enum class Kind {
    automatic,  ///< the step that scree chooses, free to change during the run
    ladder,     ///< a fixed share of it
    beyond,     ///< a fixed step above it
    usual,      ///< 0.8 sqrt(m/k) from the diagonal of each ball's stiffness, as is common
    own,        ///< the step of the scene
    varied      ///< another key than the step
  };
  Kind kind = Kind::ladder;
  std::string name;
  double step = 0;  ///< s; 0: as the scene says, or automatic
  std::vector<std::pair<std::string, std::string>> set;
  std::vector<StudyRun> runs;
  std::vector<double> flight;  ///< positions at the horizon, in order of ids, m; empty where there are none
  std::vector<double> turned;  ///< turns up to the horizon, unit quaternions w x y z; empty where nothing turns balls
  StudyRun flown;              ///< how that short run went; for the points that have a fixed step

  bool done() const { return !runs.empty() && !runs[0].values.empty(); }
  /// What went wrong, "" if nothing did.
  std::string trouble() const;
};

/// One way to measure the error, over all points.
struct StudyNorm {
  struct Entry {
    std::optional<double> value;  ///< of a quantity
    std::optional<double> error;  ///< absent where the run gave none
    bool resolved = false;        ///< at least three times the uncertainty of the reference
  };
  std::string name;
  bool relative = true;                    ///< errors are shares of the reference; otherwise in its own unit
  bool trajectory = false;                 ///< over all balls at the horizon
  bool rotation = false;                   ///< the same of their turns, rad
  std::optional<double> reference;         ///< of a quantity
  double uncertainty = 0;                  ///< of the reference, as errors are
  std::string method;                      ///< where the reference comes from
  double least_order = 2, most_order = 2;  ///< what the scheme promises here
  std::optional<double> order;             ///< fitted
  std::string fit;                         ///< how, or why there is none
  bool odd = false;                        ///< the fitted order is off by more than a half
  std::vector<Entry> entries;              ///< one for each point
};

/// A quantity at one point over all seeds, against the finest step with the same seeds.
struct StudyBias {
  std::string quantity, point;
  double bias = 0, interval = 0;  ///< mean of the paired differences and half its 95 % t-interval
  double spread = 0, mean = 0;    ///< standard deviation over seeds and mean, at the finest step
  std::size_t pairs = 0;
  bool converged = false;
};

/// How the energy residual of a point grows with the number of cycles.
struct StudyDrift {
  std::string point;
  double slope = 0, interval = 0;  ///< share of what passed through in 1e6 cycles, and half its 95 % t-interval
  uint64_t cycles = 0;             ///< over how many it was measured
};

struct Study {
  Exit code = Exit::done;
  std::string scene, folder;
  double automatic = 0;  ///< s, the least step that the automatic choice took
  double horizon = 0;    ///< s, length of the short trajectory; 0: there is none
  std::string horizon_reason;
  std::vector<std::string> quantities;
  std::vector<StudyPoint> points;
  std::vector<StudyNorm> norms;
  std::vector<StudyBias> biases;
  std::vector<StudyDrift> drifts;  ///< of the points whose energy is accounted for, 200 cycles at least
  std::vector<std::string> remarks;
  std::string picture;  ///< file, "" where none was drawn
};

/// Runs a scene at a ladder of steps and measures error against cost; writes study.csv after each point, study.md and a
/// picture at the end. A run that fails is a point without an error; the study goes on. Throws Refusal when the scene
/// cannot be studied at all. A signal ends it: what is finished is written.
Study study_scene(const StudyOptions& options, Catalogue& catalogue);

/// The answer in plain words: what the automatic step gives, what half the step costs, and what the usual step would.
std::string conclusion(const Study& study);

}  // namespace scree::core
