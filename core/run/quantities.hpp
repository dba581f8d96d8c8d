#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/run/archive.hpp"
#include "core/run/instant.hpp"
#include "core/run/published.hpp"
#include "core/scene/report.hpp"

namespace scree::core {

/// Every number of a run by its name: those the kernel and processes publish, the scene's own, and of each of these the
/// extremes `NAME.peak` (largest) and `NAME.least` (smallest). Values are those of time n: the caller has run
/// `engine.forces()`, with `sums_wanted` and `report_wanted` as `needs` says. Reading never changes the trajectory.
///
/// Extremes run from the start over the cycles that `follow` looks at: every cycle for numbers that cost nothing
/// (walls, positions of single balls, processes, counts), every tenth for those that need a pass over balls or
/// contacts, and the present one. So they do not depend on what is recorded. [one thread]
class Quantities {
 public:
  static constexpr uint64_t follow_every = 10;  ///< cycles, for extremes of what needs a pass

  explicit Quantities(Simulation& simulation);

  double value(const std::string& name);
  double value(const Formula& formula);
  bool knows(const std::string& name);
  /// "" where it is unknown, as for the scene's own.
  std::string unit(const std::string& name);
  std::string unit(const Formula& formula);  ///< that of its only name, when it is nothing but that name
  Needs needs(const std::string& name);
  Needs needs(const Formula& formula);
  bool needs_sums(const Formula& formula) { return needs(formula).sums; }
  bool needs_report(const Formula& formula) { return needs(formula).report; }
  /// For suggestions.
  std::vector<std::string> names(const std::string& like = "") const;

  /// Every name must be known, or be of a piece that a later action adds; throws SceneErrors with place and nearest
  /// name. After `Simulation::prepare`, since processes publish from then on. Begins to follow extremes that are used.
  void check(const Formula& formula);
  /// The same for all formulas of the scene at once: quantities, records, tests and expectations.
  void check_scene();

  /// What `follow` needs of the forces of this cycle.
  Needs following(uint64_t cycle) const;
  /// Call in every cycle after the forces: takes note of extremes.
  void follow();
  /// Call after an edit: what was read at this cycle no longer holds.
  void invalidate() { instant_.forget(); }
  Instant& instant() { return instant_; }

  void save(ArchiveWriter& archive, const std::string& prefix) const;
  void load(const ArchiveReader& archive, const std::string& prefix);

 private:
  struct Own {
    const Quantity* quantity;
    uint64_t stamp = 0;
    double value = 0;
    bool open = false;  ///< being evaluated: a second entry is a circle
  };
  struct Extreme {
    std::string of;
    bool peak = true;
    double seen;
  };
  const Published* published(const std::string& name);
  Extreme* extreme(const std::string& name);
  double own_value(Own& own);
  void check(const Formula& formula, Report& report);
  void check(const Quantity& quantity, Report& report);
  void check_name(const std::string& name, const Place& place, Report& report);
  bool piece_comes(const std::string& name) const;
  bool process_comes() const;

  Simulation& simulation_;
  Instant instant_;
  std::map<std::string, Own, std::less<>> own_;
  std::map<std::string, Published, std::less<>> published_;
  std::map<std::string, Extreme, std::less<>> extremes_;
};

}  // namespace scree::core
