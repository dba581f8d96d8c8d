#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/threads.hpp"
#include "core/contact/contacts.hpp"
#include "core/contact/crowd.hpp"
#include "core/contact/step_bound.hpp"
#include "core/cycle/energy_balance.hpp"
#include "core/cycle/monitors.hpp"
#include "core/cycle/motion.hpp"
#include "core/cycle/observation.hpp"
#include "core/cycle/process.hpp"
#include "core/cycle/skin.hpp"
#include "core/cycle/step_control.hpp"
#include "core/cycle/step_schedule.hpp"
#include "core/world/balls.hpp"
#include "core/world/cell.hpp"
#include "core/world/wall.hpp"

namespace scree::core {

/// A run that went wrong at a known cycle: exit 5. `balls` are the ids to look at first.
class NumericalStop : public Refusal {
 public:
  /// What the engine holds when it stops: all of one time, which can be saved, or a cycle that was left half way.
  enum class State { whole, broken };
  NumericalStop(const std::string& message, std::vector<uint64_t> worst, State left = State::broken)
      : Refusal(Exit::numerical, message), balls(std::move(worst)), state(left) {}
  std::vector<uint64_t> balls;
  State state;
};

/// A bond that broke, and when.
struct BrokenBond {
  uint64_t cycle = 0;
  double time = 0;  ///< s
  Break what;
};

/// Model time as a count: no rounding piles up while the step stays the same.
struct Clock {
  uint64_t cycle = 0;
  uint64_t base_cycle = 0;
  double base_time = 0;
  double dt = 0;       ///< of the coming drift, s
  double dt_back = 0;  ///< of the drift that led here; 0 after a start or an edit of velocities, s
  double dt_law = 0;   ///< what laws take their increments over: dt_back, or 0 when this time is evaluated again, s
  double time() const { return base_time + static_cast<double>(cycle - base_cycle) * dt; }
  void change_step(double fresh) {
    if (fresh == dt) return;
    base_time = time();
    base_cycle = cycle;
    dt = fresh;
  }
};

/// The timestep loop over everything the kernel keeps. The state stands at time n: positions x(n), velocities v(n-1/2).
/// forces() completes time n; advance() goes to n+1.
class Engine {
 public:
  /// `on_start` runs first on every helper thread, as for Team.
  Engine(unsigned threads, int isa, std::function<void(unsigned)> on_start = {});

  Balls balls;
  std::vector<Wall> walls;
  PeriodicCell cell;
  Contacts contacts;
  std::vector<Process> processes;
  StepControl step;
  EnergyBalance ledger;
  Clock clock;
  Team team;
  ProcessHost host;
  double overlap_limit = 0.5;
  double overlap_warning = 0.05;
  double wanted_skin = 0;          ///< m; 0: chosen from the radii
  bool unsafe = false;             ///< the user accepts a step above the bound
  std::string step_place;          ///< "file:line:column" of the user's own step; "" when there is none
  double idle_step = 0;            ///< s; what an automatic step is while there is no ball, where nothing limits it
  bool sums_wanted = false;        ///< forces() also sums contact force sizes (unbalanced ratio)
  bool report_wanted = false;      ///< forces() also keeps every contact's force
  std::vector<BrokenBond> broken;  ///< bonds that broke and that nobody has taken from here yet, in order
  std::function<void(const std::string&)> warn = [](const std::string&) {};

  /// Call after any edit of balls, walls, rules or processes: makes the columns exist that the scene needs, and chooses
  /// the step. Does not touch contacts' memory.
  void prepare();
  /// Call after a change of `idle_step`.
  void follow_idle_step();
  /// Detection when the skin is used up, then all contact laws. Does nothing when the forces of this time are there.
  void forces();
  /// Reads time n; forces() must have run. Never changes the trajectory.
  const Observation& observe();
  /// What is stored at time n, for the ledger; forces() must have run.
  StoredEnergy stored_energy();
  /// Call before an edit: what it does to the energy balance counts as work of the user.
  void before_edit();
  /// Row processes, kick, drift, model processes: to time n+1.
  void advance();
  /// Bonds pairs at the positions of now; forces are evaluated again. How many were bonded. With `lasting` the step is
  /// then estimated with the effort of a first time.
  uint64_t bond(const BondOrder& order, bool lasting);
  /// Call before an edit of velocities or balls: turns v(n-1/2) into v(n), so that the next kick is a half one.
  void synchronize();
  /// Call after an edit: the forces of this time are evaluated again, with increments of zero.
  void forces_outdated();

  double skin() const { return skin_.width(); }
  uint64_t rebuilds() const { return rebuilds_; }
  uint64_t contact_updates() const { return contact_updates_; }
  bool forces_current() const { return forces_current_ && contacts.built(); }
  double local_damping() const;
  /// What the last estimate of the step took, in words.
  const std::string& estimated() const { return estimated_; }
  double largest_overlap() const;  ///< of the smaller radius, over active contacts, now
  uint64_t state_hash() const;     ///< over positions, velocities, spins and contact state in id order

  /// Whether the step rests on the room round each ball, see Crowd.
  struct CrowdUse {
    double depth = 0;     ///< that overlaps were taken to have; 0: not asked yet
    uint64_t since = 0;   ///< cycle when overlaps were looked at last
    uint64_t asked = 0;   ///< cycle when it was last asked whether estimates are worth their price
    uint8_t refused = 0;  ///< they were
    uint8_t rests = 0;    ///< the step of now follows from the room
  };
  /// What a checkpoint holds beside columns.
  struct Loop {
    double ball_travel, wall_travel, extent;
    Skin::State skin;
    ContactEnergy energy;                            ///< of the last pass
    std::vector<std::array<double, 6>> wall_motion;  ///< of the last drift, while energy is traced
    uint8_t forces_current;
    uint64_t rebuilds, contact_updates;
    StepSchedule::State schedule;
    CrowdUse crowd;
  };
  Loop loop() const;
  void restore(const Loop& loop);
  void detect();  ///< rebuilds when the skin is used up
  std::pair<double, double> coming() const;

 private:
  void rebuild();
  void evaluate_forces();
  void choose_step();
  StepBound estimate();
  NetworkBound weigh(NetworkQuery& query);
  void watch_frequency();
  void watch_honesty();
  double fastest_ball() const;
  StepBound flight() const;
  std::optional<StepBound> crowded(const NetworkQuery& query, uint64_t lasted);
  bool know_crowd();
  bool estimates_pay(const LinkQuery& links, double damping, double wanted);
  void watch_depth();
  void check_cell() const;
  double room_for_skin() const;  ///< m, that the edges of the periodic cell leave
  void check_energies() const;
  double exact_travel();
  double wall_work(bool before) const;
  void drift_walls();
  void run_model_processes();
  [[noreturn]] void stop_excess(const Excess& excess) const;
  void stop_not_finite();
  void check_speed(double fastest);
  /// How many balls there are, and the sum of their ids.
  struct Census {
    std::size_t balls = 0;
    uint64_t ids = 0;
    bool operator==(const Census&) const = default;
  };
  Census census() const;
  void check_count() const;
  MotionInput motion_input();
  Observation observation_;
  std::vector<const Process*> adders_, scalers_;
  std::vector<MotionResult> motion_;  ///< of the last pass, by block
  std::vector<double> block_sums_;    ///< of the row processes, by block
  StepBound possible_;
  StepSchedule schedule_;
  CrowdUse crowd_use_;
  std::unique_ptr<Crowd> crowd_;  ///< null: to be made when it is asked for
  std::string estimated_;
  FrequencyWatch frequency_;
  HonestyWatch honesty_;
  Census counted_;  ///< by the last prepare()
  Skin skin_;
  double least_radius_ = 0, largest_radius_ = 0, extent_ = 0;
  double ball_travel_ = 0, wall_travel_ = 0;
  std::vector<std::array<double, 6>> wall_motion_;  ///< velocity and spin of the last drift, for the ledger
  uint64_t rebuilds_ = 0, contact_updates_ = 0;
  bool forces_current_ = false, warned_overlap_ = false;
};

}  // namespace scree::core
