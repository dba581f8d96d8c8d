#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/array.hpp"

namespace scree::core {

/// Components a ball may have. Each is one array; a column exists only when something asked for it.
enum class Column : uint8_t {
  x,
  y,
  z,  ///< centre, m
  vx,
  vy,
  vz,            ///< velocity at the half step before, m/s
  radius,        ///< m
  mass,          ///< kg
  inverse_mass,  ///< 1/kg, 0 for a ball that is fixed in all six directions
  wx,
  wy,
  wz,  ///< spin at the half step before, rad/s
  reference_x,
  reference_y,
  reference_z,  ///< centre when the contact lists were built, m
  force_x,
  force_y,
  force_z,  ///< applied force, N
  moment_x,
  moment_y,
  moment_z,  ///< applied moment, N m
  count
};

/// Directions in which a ball is fixed, one bit each.
enum Fixed : uint8_t { fix_x = 1, fix_y = 2, fix_z = 4, fix_wx = 8, fix_wy = 16, fix_wz = 32, fix_all = 63 };

/// All balls as a structure of arrays. Rows are in spatial order and move when lists are rebuilt; ids never change.
class Balls {
 public:
  Balls();
  std::size_t size() const { return id_.size(); }

  /// Makes a column exist (zero-filled) and notes why; asking again is free.
  void require(Column column, const std::string& reason);
  bool has(Column column) const { return present_[static_cast<std::size_t>(column)]; }
  /// Null when the column does not exist.
  double* operator[](Column c) { return has(c) ? values_[static_cast<std::size_t>(c)].data() : nullptr; }
  const double* operator[](Column c) const { return has(c) ? values_[static_cast<std::size_t>(c)].data() : nullptr; }

  /// A named column for a contact property that is given on pieces.
  double* property(const std::string& name);
  double* require_property(const std::string& name);
  const std::map<std::string, Array<double>>& properties() const { return properties_; }

  uint64_t* id() { return id_.data(); }
  const uint64_t* id() const { return id_.data(); }
  uint16_t* group() { return group_.data(); }
  const uint16_t* group() const { return group_.data(); }
  uint8_t* fixed() { return fixed_.data(); }  ///< null while no ball is fixed
  const uint8_t* fixed() const { return fixed_.data(); }
  uint8_t* require_fixed();

  /// Appends rows; new elements are zero.
  void resize(std::size_t rows);
  /// Gives back the room that adding one by one had reserved.
  void trim();
  /// Row k of the result is row order[k] of before.
  void reorder(const uint32_t* order);
  /// Keeps the rows where keep[row] is not 0.
  void keep(const std::vector<uint8_t>& keep);
  /// Sets inverse_mass from mass and the fixed bits.
  void update_inverse_mass();

  struct Listed {
    std::string name, reason;
    std::size_t bytes_per_ball, bytes;
  };
  std::vector<Listed> list() const;  ///< what exists and why, for `explain` and tests
  static const char* name(Column column);

  /// Largest id in use plus one.
  uint64_t next_id = 1;

 private:
  template <class F>
  void each_array(F f);
  Array<double> values_[static_cast<std::size_t>(Column::count)];
  bool present_[static_cast<std::size_t>(Column::count)] = {};
  std::string reason_[static_cast<std::size_t>(Column::count)];
  std::map<std::string, Array<double>> properties_;
  Array<uint64_t> id_;
  Array<uint16_t> group_;
  Array<uint8_t> fixed_;
};

}  // namespace scree::core
