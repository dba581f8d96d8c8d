#pragma once
#include <scree/abi.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/world/balls.hpp"
#include "core/world/wall.hpp"

namespace scree::core {

/// A process of the scene: a plug-in's object, what it saves and what it published.
struct Process {
  std::string name;
  std::string plugin;  ///< for messages
  const scree_process* table = nullptr;
  std::shared_ptr<void> object;
  std::vector<double> state;  ///< saved words
  std::vector<double> sums;   ///< totals of the row sums of the last cycle

  bool has_rows() const { return table->rows[0] != nullptr; }
  bool adds() const { return (table->flags & SCREE_ADDS_FORCE) != 0; }
  bool needs(uint32_t column) const;
};

/// Processes that act on rows, in the order they run: those that add forces, then those that scale them; by name in
/// each.
std::vector<const Process*> row_order(const std::vector<Process>& processes, bool adding);

/// What a process asked to be bonded, see scree_host.bond.
struct BondRequest {
  std::string rule;
  double gap = 0;
  bool again = false;
};

/// What a model process may ask of the kernel.
class ProcessHost {
 public:
  ProcessHost(Balls& balls, std::vector<Wall>& walls);
  const scree_host* host() const { return &host_; }
  void fill_views();                ///< from walls, before a step
  void take_views();                ///< velocities back to walls, after it
  const Wall* spoilt_wall() const;  ///< one whose velocity in the views is not finite; null: none
  /// Who speaks next: its quantities are called `processes.NAME.quantity`. While it prepares, a value counts only where
  /// there is none yet, so that an edit of the scene does not set back what the process has published since.
  void listen_to(const std::string& process, bool prepares);
  std::map<std::string, double> published;
  std::vector<BondRequest> take_bonds();  ///< those asked for since the last call
  /// Whether a rule of this name makes bonds.
  std::function<bool(const std::string& rule)> can_bond = [](const std::string&) { return false; };
  /// Stiffness of the contacts of a wall, N/m; asked only for walls that a process looks at.
  std::function<double(std::size_t wall)> wall_stiffness = [](std::size_t) { return 0.0; };

 private:
  static int wall(void* self, const char* name, uint32_t* handle);
  static scree_wall_view* wall_view(void* self, uint32_t handle);
  static void publish(void* self, const char* quantity, double value);
  static const double* column(void* self, uint32_t column, uint32_t component, uint64_t* rows);
  static const uint64_t* ids(void* self, uint64_t* rows);
  static int read(void* self, const char* quantity, double* value);
  static int bond(void* self, const char* rule, double gap, int again);
  Balls& balls_;
  std::vector<Wall>& walls_;
  std::vector<scree_wall_view> views_;
  std::vector<uint8_t> stiffness_known_;  // of the view, since it was filled
  std::string prefix_;
  bool prepares_ = false;
  std::vector<BondRequest> bonds_;
  scree_host host_{};
};

}  // namespace scree::core
