#include <scree/wall.hpp>

#include <stdexcept>

namespace {

using namespace scree;

/// A wall: a thin round plate that balls touch from both sides and at its rim.
///
/// A wall is geometry in its own frame. Where it moves, which forces act on it and which law holds are the business of
/// the scene.
struct PluginName {
  // What a scene gives. A key that it leaves out keeps the value written here, which is then the default.
  Vec3 centre;
  Vec3 normal{0, 0, 1};
  double radius = 1;
  Vec3 axis{0, 0, 1};  // the normal with length 1

  static void describe(Settings<PluginName>& s) {
    s.vector("centre", &PluginName::centre, "m", "middle of the plate").required();
    s.vector("normal", &PluginName::normal, "1", "axis of the plate, of any length; 0 0 1 when absent");
    s.number("radius", &PluginName::radius, "m", "of the plate").above(0).required();
  }

  // After all keys are in place: refuse by throwing; the text reaches the user with its place in the scene.
  void check() {
    if (normal.norm() == 0) throw std::runtime_error("'normal' is zero; give a vector along the axis of the plate");
    axis = normal.normalized();
  }

  // Adds every piece of the surface that lies nearer to a ball's centre than `reach`. Runs on any thread.
  void touch(const Vec3& ball, double reach, Touches& out) const {
    constexpr uint32_t face = 0, rim = 1;  // a contact remembers its patch as long as it lasts
    const Vec3 from_centre = ball - centre;
    const double height = from_centre.dot(axis);
    const Vec3 in_plane = from_centre - height * axis;
    const double off_axis = in_plane.norm();
    const bool over_face = off_axis <= radius;
    const Vec3 nearest = centre + (over_face ? in_plane : (radius / off_axis) * in_plane);
    const Vec3 to_wall = nearest - ball;
    const double distance = to_wall.norm();
    if (distance < reach) out.add(to_wall.normalized(), distance, over_face ? face : rim);
  }
};

}  // namespace

SCREE_PLUGIN(scree::wall<PluginName>("plugin_name", "0.1.0", "thin round plate"))
