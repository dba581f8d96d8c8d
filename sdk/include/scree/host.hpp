#pragma once
/// What a process sees of the running scene in `prepare` and `step`. [one thread]; nothing here may be kept beyond the
/// call except the handle of a wall.
#include <scree/abi.h>
#include <scree/math.hpp>

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

namespace scree {

/// A wall that `Host::wall` found; stays valid until the next `prepare`, which comes after each edit of the scene.
struct Wall {
  uint32_t handle = UINT32_MAX;
};

/// The way to walls, quantities and columns.
class Host {
 public:
  explicit Host(const scree_host& table) : table_(&table) {}

  /// Looks a wall up by its name in the scene; throws when there is none.
  Wall wall(const std::string& name) const {
    Wall found;
    if (table_->wall(table_->self, name.c_str(), &found.handle) == 0)
      throw std::runtime_error("there is no wall '" + name + "'");
    return found;
  }
  /// Force (N) and moment (N m, about its centre of rotation) of the last force pass on the wall, as seen by the wall:
  /// a floor is pushed to negative z. Area (m2, 0 when unbounded) and normal stiffness of its active contacts (N/m, not
  /// negative). Its velocity (m/s) and spin (rad/s) may be written in `step`, and hold until they are written again.
  scree_wall_view& view(Wall wall) const {
    scree_wall_view* found = table_->wall_view(table_->self, wall.handle);
    if (found == nullptr) throw std::runtime_error("the wall is no longer there");
    return *found;
  }
  /// Makes `processes.NAME.quantity` readable by scenes, recorders and other processes; NAME is that of the process in
  /// the scene. Publish each quantity in `prepare` too, so that a scene can name it before the first cycle: a value
  /// given there counts only where there is none yet, and so does not set back a running process. SI units.
  void publish(const char* quantity, double value) const { table_->publish(table_->self, quantity, value); }
  /// What a process published, by its full name `processes.NAME.quantity`; throws when there is none of this name.
  double read(const std::string& quantity) const {
    double value = 0;
    if (table_->read(table_->self, quantity.c_str(), &value) == 0)
      throw std::runtime_error("there is no quantity '" + quantity + "'");
    return value;
  }
  /// One component of a column over all balls, in row order; empty when the scene does not keep it. Rows change places
  /// between calls, so keep ids, never rows.
  std::span<const double> column(uint32_t column, uint32_t component) const {
    uint64_t rows = 0;
    const double* first = table_->column(table_->self, column, component, &rows);
    return first == nullptr ? std::span<const double>() : std::span<const double>(first, rows);
  }
  /// The id of each row.
  std::span<const uint64_t> ids() const {
    uint64_t rows = 0;
    const uint64_t* first = table_->ids(table_->self, &rows);
    return first == nullptr ? std::span<const uint64_t>() : std::span<const uint64_t>(first, rows);
  }
  /// Bonds, once the forces of the coming time are known, all pairs of a rule whose gap is at most `gap` (m, at least
  /// 0) and which are not bonded; without `again` none whose bond broke before. In `prepare` it only tells whether that
  /// is possible. Throws when no rule has this name, or its contact model makes no bonds.
  void bond(const std::string& rule, double gap, bool again) const {
    if (table_->struct_size < offsetof(scree_host, bond) + sizeof table_->bond)
      throw std::runtime_error("this scree is too old to make bonds");
    if (table_->bond(table_->self, rule.c_str(), gap, again ? 1 : 0) == 0)
      throw std::runtime_error("rule '" + rule +
                               "' cannot bond: there is none of this name, its contact model makes no bonds, or the "
                               "gap is negative or not a number");
  }

 private:
  const scree_host* table_;
};

/// One call of `step`.
struct Step {
  explicit Step(const scree_step& table) : cycle(table.cycle), time(table.time), dt(table.dt), host(*table.host) {}
  uint64_t cycle;  ///< cycles done
  double time;     ///< model time after them, s
  double dt;       ///< step of the coming cycle, s, above 0
  Host host;
};

}  // namespace scree
