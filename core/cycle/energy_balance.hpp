#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/contact/contact_energy.hpp"

namespace scree::core {

/// Work done on rows by the forces of one time, over half of the drift before it and half of the one after it, J. With
/// that split the work of a force follows the trapezoidal rule, and the product of the two half-step velocities changes
/// by exactly that work.
struct RowWork {
  double body = 0;      ///< of applied forces and processes that add
  double damping = 0;   ///< of processes that scale, mostly negative
  double boundary = 0;  ///< of what moves balls whose motion is prescribed
  double kinetic = 0;   ///< after the kick, J
  RowWork& operator+=(const RowWork& other) {
    body += other.body;
    damping += other.damping;
    boundary += other.boundary;
    kinetic += other.kinetic;
    return *this;
  }
};

/// A sum whose rounding is carried along (Neumaier 1974).
struct CarefulSum {
  double sum = 0, rest = 0;
  void add(double value);
  double value() const { return sum + rest; }
};

/// What is stored at one time, J.
struct StoredEnergy {
  double kinetic = 0;         ///< with v(n)
  double kinetic_shadow = 0;  ///< with the product of the two half-step velocities
  double strain = 0, bond = 0;
  RowWork before;          ///< of the forces of this time over half of the drift that led here
  double wall_before = 0;  ///< the same of the walls
};

/// The energy balance of a run: what was put in, what is stored, what was lost. Terms are histories since the ledger
/// began, up to the drift of the last advance.
class EnergyBalance {
 public:
  bool on = false;

  void add_contacts(const ContactEnergy& pass);
  void add_rows(const RowWork& work, double stored_in_contacts);
  void add_walls(double work);

  /// The names of terms, in order; `energy.NAME` are the quantities.
  static const std::vector<std::string>& terms();
  /// A term now; "residual" and "residual_share" too.
  double value(const std::string& term, const StoredEnergy& now) const;
  double residual(const StoredEnergy& now) const;
  /// Residual over the largest energy stored plus all energy that passed through.
  double residual_share(const StoredEnergy& now) const;

  bool begun() const { return begun_; }
  /// What is constant under leapfrog depends on the step: with another step it differs by this much, J.
  void step_changed(double difference) { start_ += difference; }
  void begin(const StoredEnergy& now);
  /// What an edit does to the balance counts as work of the user: call before it and after it, when the forces of the
  /// same time are there again.
  void before_edit(const StoredEnergy& now);
  bool edited() const { return edited_.has_value(); }
  void after_edit(const StoredEnergy& now);

  /// For checkpoints.
  static constexpr std::size_t saved_words = 20;
  std::array<double, saved_words> save() const;
  void load(const std::array<double, saved_words>& words);

 private:
  enum Term : std::size_t { body, boundary, friction, dashpot, damping, broken, edits, term_count };
  double balance(const StoredEnergy& now) const;
  std::array<CarefulSum, term_count> total_{};
  CarefulSum passed_;
  double most_stored_ = 0, start_ = 0;
  bool begun_ = false;
  std::optional<double> edited_;  ///< residual before the edit
};

}  // namespace scree::core
