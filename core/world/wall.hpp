#pragma once
#include <scree/abi.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace scree::core {

/// A wall: geometry of a plug-in in its own frame, and the pose, velocity and resultants that the kernel keeps.
/// Walls have no mass; their velocity is prescribed.
struct Wall {
  std::string name;
  std::string plugin;  ///< for messages
  const scree_wall* table = nullptr;
  std::shared_ptr<void> geometry;         ///< the plug-in's object
  std::map<std::string, double> contact;  ///< own contact properties, SI

  std::array<double, 3> velocity{}, spin{};  ///< m/s, rad/s about `centre`
  std::array<double, 3> centre{};            ///< of rotation now, m
  std::array<double, 3> first_centre{};      ///< of rotation at the start: the frame of the geometry, m
  std::array<double, 4> turn{1, 0, 0, 0};    ///< unit quaternion w x y z from the geometry's frame to the scene's
  std::array<double, 3> force{}, moment{};   ///< on the wall at the last force pass, N, N m about `centre`
  uint64_t contacts = 0;                     ///< active ones at the last force pass

  /// Asks the geometry for the touches of n balls (abi.h), and checks what it wrote: throws Refusal (exit 4) when it
  /// threw, or gave what no surface can. [any thread]
  uint32_t touch(uint32_t n, const double* x, const double* y, const double* z, const double* reach,
                 const scree_touches& out) const;
  /// Throws Refusal (exit 4): this wall `does` something that its plug-in must not do.
  [[noreturn]] void refuse(const std::string& does) const;
  bool turned() const { return turn[0] != 1.0; }
  /// Centre of a ball in the geometry's frame.
  std::array<double, 3> to_frame(const std::array<double, 3>& point) const;
  /// A direction of the geometry's frame in the scene's.
  std::array<double, 3> from_frame(const std::array<double, 3>& direction) const;
  /// A direction of the scene's frame in the geometry's.
  std::array<double, 3> direction_to_frame(const std::array<double, 3>& direction) const;
  /// Moves by one step: exact rotation, so that a spinning wall does not grow.
  void drift(double dt);
  /// Upper bound of how far a point within `size` of the centre moves in dt, m.
  double travel(double dt, double size) const;
};

}  // namespace scree::core
