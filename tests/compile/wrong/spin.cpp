// Reads the spin without having asked for it.
#include <scree/contact_model.hpp>

namespace {
using namespace scree;

struct Model {
  double kn;
  static void describe(Properties<Model>&) {}
  void law(const Contact& c, Response& r) const { r.force = c.spin; }
  Stiffness stiffness(const Contact&) const { return {.normal = 1}; }
};

}  // namespace

SCREE_CONTACT_MODEL(Model, "model", "0.1.0")
