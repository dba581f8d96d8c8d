#include "core/run/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/base/log.hpp"
#include "core/run/explain.hpp"
#include "core/run/output_folder.hpp"
#include "core/run/signals.hpp"
#include "core/run/study_drift.hpp"
#include "core/run/study_files.hpp"
#include "core/run/study_flight.hpp"
#include "core/run/study_judge.hpp"
#include "core/run/study_steps.hpp"

namespace scree::core {

namespace {

namespace fs = std::filesystem;

bool stopped(Exit code) { return code == Exit::interrupted || code == Exit::terminated || code == Exit::time_limit; }

/// Keeps log lines of a run off the terminal while it lives; its log file has them.
class Hush {
 public:
  explicit Hush(const log::Settings& shown) : shown_(shown) {
    log::Settings silent = shown;
    silent.silent = true;
    log::open(silent);
  }
  ~Hush() { log::open(shown_); }
  Hush(const Hush&) = delete;
  Hush& operator=(const Hush&) = delete;

 private:
  log::Settings shown_;
};

/// Goes through the points of a study and keeps its files up to date.
class Studying {
 public:
  Studying(const StudyOptions& options, Catalogue& catalogue)
      : options_(options), catalogue_(catalogue), scene_(read_scene(options.read, catalogue)), folder_(make_folder()) {
    study_.scene = scene_.file;
    study_.folder = folder_.path();
    cell_from(scene_);
    if (!options.quick)
      for (const Expect& expect : scene_.expect) add_quantity(expect.quantity->text());
    declared_ = study_.quantities.size();
    for (const std::string& name : options.quantities) add_quantity(name);
    if (study_.quantities.empty() && !options.quick)
      for (const Quantity& quantity : scene_.quantities) add_quantity(quantity.name);
    if (study_.quantities.empty() && !options.quick)
      study_.remarks.push_back(
          "The scene has no 'expect' and no 'quantities', and no --quantity was given: only trajectories and energy "
          "are compared.");
  }

  Study study() {
    try {
      begin();
      for (std::size_t k = 0; k < study_.points.size() && !stopped(study_.code); ++k) {
        run_point(study_.points[k]);
        write();
        tell(k);
      }
    } catch (const Refusal& refusal) {
      if (!stopped(refusal.code())) throw;
      study_.code = refusal.code();
    }
    if (stopped(study_.code)) {
      study_.remarks.push_back("The study was stopped before its end: points without figures were not reached.");
      judge(study_, horizon_, expected_, cell_);
    }
    finish();
    return study_;
  }

 private:
  OutputFolder make_folder() const {
    first_run(scene_);
    const std::string name = scene_.file.empty() ? "scree" : fs::path(scene_.file).stem().string();
    return OutputFolder::create(options_.folder.empty() ? name + ".study" : options_.folder, false);
  }

  void cell_from(const Scene& scene) {
    if (!scene.cell) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cell_.low[axis] = scene.cell->low[axis];
      cell_.high[axis] = scene.cell->high[axis];
      cell_.periodic[axis] = scene.cell->periodic[axis];
    }
  }

  void add_quantity(const std::string& text) {
    if (std::find(study_.quantities.begin(), study_.quantities.end(), text) == study_.quantities.end())
      study_.quantities.push_back(text);
  }

  Scene scene_for(const StudyPoint& point, std::optional<uint64_t> seed = std::nullopt) const {
    StudyChange change;
    change.own = point.kind == StudyPoint::Kind::own || point.kind == StudyPoint::Kind::varied;
    change.step = point.step;
    change.unsafe = point.kind == StudyPoint::Kind::beyond || point.kind == StudyPoint::Kind::usual;
    change.set = point.set;
    if (seed) change.set.emplace_back("seed", std::to_string(*seed));
    Scene scene = changed_scene(options_.read, catalogue_, change, cycle_length_);
    if (options_.quick) scene.expect.clear();
    if (quick_time_ > 0) cut_after(scene, quick_time_);
    add_energy(scene);
    // What is measured beside the expectations is read where they are.
    for (std::size_t k = declared_; k < study_.quantities.size(); ++k) {
      Expect more;
      more.text = more.source = study_.quantities[k];
      more.quantity = std::make_shared<Formula>(study_.quantities[k], scene.vars, Place{"--quantity", 0, 0});
      more.low = -INFINITY;
      if (more.text == energy_residual) {
        more.equals = 0;
        more.tolerance = INFINITY;
        more.source = "energy is conserved";
      }
      scene.expect.push_back(std::move(more));
    }
    return scene;
  }

  RunOptions quiet_options() const {
    RunOptions run = options_.run;
    run.quiet = true;
    return run;
  }

  void begin() {
    StudyPoint automatic;
    automatic.kind = StudyPoint::Kind::automatic;
    automatic.name = "automatic";
    keep_energy(automatic);
    first_step(automatic);
    if (options_.quick) shorten();
    options_.note("automatic step: a whole run with it");
    run_full(automatic);
    const StudyRun& run = automatic.runs[0];
    if (stopped(run.code)) {
      study_.points.push_back(automatic);
      study_.code = run.code;
      return;
    }
    if (run.values.empty() && !study_.quantities.empty())
      throw Refusal(run.code,
                    "the scene does not come to its end with the automatic step, so there is nothing to "
                    "compare with: " +
                        run.message);
    study_.automatic = std::min(study_.automatic, run.step);
    study_.points.push_back(automatic);
    find_short(automatic, run.model_time);
    lay_out();
  }

  static bool traces_energy(const Component& process) { return (process.process().flags & SCREE_TRACES_ENERGY) != 0; }

  const Component* energy_account() const {
    for (const std::string& name : catalogue_.names(Kind::process)) try {
        const Component& process = catalogue_.open(Kind::process, name);
        if (traces_energy(process)) return &process;
      } catch (const Refusal&) {
        // A library that is refused is told of where a scene names it.
      }
    return nullptr;
  }

  // All points keep the energy account, whose cost is then the same share of each, or none does.
  void keep_energy(const StudyPoint& automatic) {
    std::string why = "no plug-in keeps an energy account";
    if ((ledger_ = energy_account()) != nullptr) try {
        const Hush hush(options_.log);
        begin_scene(scene_for(automatic), catalogue_, quiet_options());
        add_quantity(energy_residual);
        return;
      } catch (const Refusal& refusal) {
        why = refusal.what();
      }
    ledger_ = nullptr;
    if (options_.quick && study_.quantities.empty())
      throw Refusal(Exit::scene, "a quick study compares the energy balance alone, and here is none: " + why +
                                     "; leave out --quick, or say what to compare with --quantity");
    study_.remarks.push_back("The energy residual is left out: " + why);
  }

  void add_energy(Scene& scene) const {
    if (ledger_ == nullptr) return;
    const auto& uses = scene.processes;
    if (std::any_of(uses.begin(), uses.end(),
                    [](const ProcessUse& use) { return traces_energy(*use.process.component); }))
      return;
    std::string name = "energy";
    while (std::any_of(uses.begin(), uses.end(), [&](const ProcessUse& use) { return use.name == name; })) name += "_";
    scene.processes.push_back({name, {ledger_, {}, 0, {}}, {}});
  }

  // The step of the first cycle, and the scene's own, which lengths in cycles are meant for.
  void first_step(const StudyPoint& automatic) {
    {
      const Hush hush(options_.log);
      const auto simulation = begin_scene(scene_for(automatic), catalogue_, quiet_options());
      stand_before_first_cycle(*simulation);
      study_.automatic = simulation->engine.clock.dt;
    }
    if (!(study_.automatic > 0))
      throw Refusal(Exit::scene, scene_.file +
                                     ": error: the scene has no ball at its first cycle, so it has no step "
                                     "that could be studied");
    cycle_length_ = scene_.timestep.value_or(study_.automatic);
    for (const Stage& stage : scene_.stages)
      for (const Action& action : stage.actions)
        if (const auto* what = std::get_if<RunAction>(&action.what); what != nullptr && what->length.cycles) {
          study_.remarks.push_back(fmt::format(
              "Lengths that the scene gives in cycles were run as the time of that many cycles of {:.6g} s.",
              cycle_length_));
          return;
        }
  }

  // The beginning of the scene is enough to see whether the energy balance closes, if it has enough cycles to tell.
  void shorten() {
    const double whole = length_of(scene_, cycle_length_);
    const double share = std::max(0.02 * whole, 500 * study_.automatic);
    if (whole > 0 && share >= whole) {
      study_.remarks.push_back(
          "A quick study compares the energy balance alone; the scene is so short that it was run whole.");
      return;
    }
    quick_time_ = share;
    study_.remarks.push_back(
        fmt::format("A quick study compares the energy balance alone, and over the first {:.3g} s of the scene{}: two "
                    "per cent of its time or 500 steps, whichever is longer. What happens later it cannot know.",
                    share, whole > 0 ? fmt::format(" of {:.3g} s", whole) : ""));
  }

  void find_short(const StudyPoint& automatic, double whole) {
    Scene one = scene_for(automatic), twin = scene_for(automatic);
    double longest = whole;
    if (const RunAction& run = first_run(one); run.length.time) longest = std::min(longest, *run.length.time);
    options_.note("short trajectory: how long can runs be compared ball by ball?");
    {
      const Hush hush(options_.log);
      horizon_ = find_horizon(one, std::move(twin), catalogue_, quiet_options(), longest);
    }
    if (options_.quick) {
      if (horizon_.usual_step == 0)
        study_.remarks.push_back(
            "Nothing touched in the part of the scene that was looked at, so this study says nothing of "
            "contacts; leave out --quick.");
      return;
    }
    study_.horizon = horizon_.time;
    study_.horizon_reason = horizon_.reason;
    if (horizon_.time < 4 * study_.automatic) {
      study_.remarks.push_back(
          fmt::format("Trajectories are not compared: after {:.3g} s {}, which is less than four steps.", horizon_.time,
                      horizon_.reason));
      study_.horizon = 0;
    }
  }

  void add_step(StudyPoint::Kind kind, const std::string& name, double step) {
    StudyPoint point;
    point.kind = kind;
    point.name = name;
    point.step = step;
    study_.points.push_back(point);
  }

  void lay_out() {
    StudyPoint any;
    const Scene sample = scene_for(any);
    add_step(StudyPoint::Kind::beyond, "automatic*2", aligned_step(sample, 2 * study_.automatic));
    const unsigned rungs = options_.quick ? 3 : options_.rungs;
    double last = 0;
    for (unsigned k = 0; k < rungs; ++k) {
      const double share = options_.quick ? std::ldexp(1.0, static_cast<int>(k)) : std::pow(2.0, 0.5 * k);
      const double step = aligned_step(sample, study_.automatic / share);
      if (step == last) continue;
      last = step;
      add_step(StudyPoint::Kind::ladder, fmt::format("automatic/{:.3g}", share), step);
    }
    if (horizon_.usual_step > 0)
      add_step(StudyPoint::Kind::usual, "0.8 sqrt(m/k)", aligned_step(sample, 0.8 * horizon_.usual_step));
    else
      study_.remarks.push_back(
          "The usual step 0.8 sqrt(m/k) is left out: nothing touched within the short trajectory.");
    if (scene_.timestep) add_step(StudyPoint::Kind::own, "own step", *scene_.timestep);
    for (const Variation& variation : options_.vary)
      for (const std::string& value : variation.values) {
        StudyPoint point;
        point.kind = StudyPoint::Kind::varied;
        point.name = variation.key + "=" + value;
        point.set.emplace_back(variation.key, value);
        study_.points.push_back(point);
      }
  }

  void run_point(StudyPoint& point) {
    if (point.runs.empty() && !study_.quantities.empty()) run_full(point);
    if (!point.runs.empty() && stopped(point.runs.back().code)) {
      study_.code = point.runs.back().code;
      return;
    }
    if (study_.horizon > 0 && point.step > 0) {
      const double cycles = std::ceil(study_.horizon / point.step * (1 - 1e-12));
      StudyPoint flying = point;
      flying.step = study_.horizon / cycles;
      flying.kind = point.kind == StudyPoint::Kind::own ? StudyPoint::Kind::usual : point.kind;
      const Hush hush(options_.log);
      Flight end = fly(scene_for(flying), catalogue_, quiet_options(), static_cast<uint64_t>(cycles), point.flown);
      point.flight = std::move(end.positions);
      point.turned = std::move(end.turned);
      if (stopped(point.flown.code)) study_.code = point.flown.code;
    }
  }

  // All repeats, or all seeds. A run that does not end of itself is cut at four times the model time of the first.
  void run_full(StudyPoint& point) {
    const unsigned repeats = options_.quick ? 1 : options_.repeats;
    const unsigned count = options_.seeds > 0 ? options_.seeds : repeats;
    for (unsigned k = 0; k < count; ++k) {
      const uint64_t seed = scene_.seed + (options_.seeds > 0 ? k : 0);
      try {
        point.runs.push_back(one_run(scene_for(point, options_.seeds > 0 ? std::optional(seed) : std::nullopt), point));
      } catch (const Refusal& refusal) {
        StudyRun refused;
        refused.code = refusal.code();
        refused.message = refusal.what();
        point.runs.push_back(refused);
      }
      StudyRun& run = point.runs.back();
      run.seed = seed;
      if (run.values.empty()) return;
      if (options_.seeds == 0 && run.state_hash != point.runs[0].state_hash)
        study_.remarks.push_back("Two runs of the point '" + point.name +
                                 "' ended in different states: a plug-in is not deterministic; check yours with scree "
                                 "vet, and report it otherwise.");
    }
  }

  StudyRun one_run(Scene scene, const StudyPoint& point) {
    StudyRun out;
    RunOptions run = quiet_options();
    run.output = folder_.file(folder_name(point));
    fs::remove_all(run.output);
    const double whole = study_.points.empty() ? 0 : study_.points[0].runs[0].model_time;
    const double step = point.step > 0 ? point.step : study_.automatic;
    if (whole > 0) run.cycles = static_cast<uint64_t>(std::ceil(4 * whole / step)) + 100;
    run.at_end = [&out](Simulation& simulation) {
      out.contact_updates = simulation.engine.contact_updates();
      out.ball_steps = simulation.engine.balls.size() * simulation.engine.clock.cycle;
    };
    ResidualTrace trace;
    // The repeats are for the wall time: they go without.
    if (ledger_ != nullptr && point.runs.empty())
      run.at_cycle = [&trace](Simulation& simulation) { trace.look(simulation); };
    const Hush hush(options_.log);
    const RunResult result = run_scene(std::move(scene), catalogue_, run);
    out.residual = trace.points();
    out.code = result.code;
    out.message = result.summary.message;
    out.cycles = result.summary.cycles.value_or(0);
    out.model_time = result.summary.model_time.value_or(0);
    out.step = result.summary.timestep ? result.summary.timestep->used : 0;
    out.wall = result.cycle_seconds;
    out.state_hash = result.summary.state_hash.value_or(0);
    for (const ExpectationResult& expectation : result.summary.expectations) {
      const auto at = std::find(study_.quantities.begin(), study_.quantities.end(), expectation.quantity);
      out.values.resize(study_.quantities.size(), std::nan(""));
      if (at != study_.quantities.end())
        out.values[static_cast<std::size_t>(at - study_.quantities.begin())] = expectation.value;
      if (expected_.size() < result.summary.expectations.size()) expected_.push_back(expectation);
    }
    if (out.values.empty() && out.code == Exit::done) {
      out.code = Exit::numerical;
      out.message = "it did not come to its end in four times the model time of the run with the automatic step";
    }
    return out;
  }

  static std::string folder_name(const StudyPoint& point) {
    std::string name = point.name;
    for (char& c : name)
      if (c == '*')
        c = 'x';
      else if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '=' && c != '-')
        c = '_';
    return name.substr(0, 100);
  }

  void write() {
    judge(study_, horizon_, expected_, cell_);
    put("study.csv", study_table(study_));
  }
  void put(const std::string& name, const std::string& text) {
    if (!folder_.files().replace(name, text.data(), text.size())) throw Refusal(Exit::io, folder_.files().error());
  }

  void tell(std::size_t k) {
    const StudyPoint& point = study_.points[k];
    const StudyCost cost = cost_of(point);
    std::string line = fmt::format("[{}/{}] {}", k + 1, study_.points.size(), point.name);
    if (cost.run != nullptr) line += fmt::format(": step {:.4g} s, {:.3g} s", cost.run->step, cost.wall);
    if (const std::string trouble = point.trouble(); !trouble.empty()) line += ": " + trouble;
    options_.note(line);
  }

  void finish() {
    put("study.csv", study_table(study_));
    if (const std::string plot = study_plot(study_); !plot.empty()) {
      put("study.gnuplot", plot);
      const std::string why = draw(folder_.path(), "study.gnuplot");
      if (why.empty())
        study_.picture = "study.svg";
      else
        study_.remarks.push_back("No picture was drawn: " + why + "; study.gnuplot is its input.");
    }
    put("study.md", study_report(study_));
    folder_.files().flush();
  }

  StudyOptions options_;
  Catalogue& catalogue_;
  Scene scene_;
  OutputFolder folder_;
  Study study_;
  Horizon horizon_;
  PeriodicCell cell_;
  std::vector<ExpectationResult> expected_;
  const Component* ledger_ = nullptr;  ///< the process that keeps the energy account, null: none does
  std::size_t declared_ = 0;           ///< how many of the quantities are those of `expect`
  double cycle_length_ = 0;
  double quick_time_ = 0;  ///< s of the stages that a quick study runs, 0: all of them
};

}  // namespace

std::string StudyPoint::trouble() const {
  for (const StudyRun& run : runs)
    if (run.values.empty() && run.code != Exit::done) return status_word(run.code) + ": " + run.message;
  if (flown.code != Exit::done) return "short trajectory: " + status_word(flown.code) + ": " + flown.message;
  return "";
}

Study study_scene(const StudyOptions& options, Catalogue& catalogue) { return Studying(options, catalogue).study(); }

}  // namespace scree::core
