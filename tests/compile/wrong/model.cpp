// A right model unless WRONG is 1 to 11: then it has one mistake, and the compiler says which.
#include <scree/contact_model.hpp>

#include <string>

namespace {
using namespace scree;

struct Model {
#if WRONG == 1
  long kn;
#elif WRONG == 2
  double kn;

 private:
  [[maybe_unused]] double hidden;

 public:
#else
  double kn;
#endif
  static void describe(Properties<Model>&) {}
#if WRONG == 3
  struct State {
    float shear;
  };
#elif WRONG == 4
  struct State {
    std::string shear;
  };
#else
  struct State {
    Vec3 shear;
    double more[2];
  };
#endif

#if WRONG == 5
  void laww(const Contact& c, State&, Response& r) const { r.force = -c.gap * c.normal; }
#elif WRONG == 6
  void law(const Contact& c, State&, Response& r) { r.force = -c.gap * c.normal; }
#else
  void law(const Contact& c, State&, Response& r) const { r.force = -c.gap * c.normal; }
#endif

#if WRONG == 7
  double stiffness(const Contact&) const { return 1; }
#elif WRONG != 8
  Stiffness stiffness(const Contact&) const { return {.normal = 1}; }
#endif

#if WRONG == 9
  struct Bond {
    double mode;
  };
  void law(const Contact&, State&, Bond&, Response&) const {}
  bool broken(const Bond&) const { return false; }
#elif WRONG == 10
  double reach() const { return 0; }
#elif WRONG == 11
  void energy(const Contact&, Energies&) const {}
#endif
};

}  // namespace

SCREE_CONTACT_MODEL(Model, "model", "0.1.0")
