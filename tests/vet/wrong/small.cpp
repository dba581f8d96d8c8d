// A law of a few lines, built in ways in which a library should not be built.
#include <scree/contact_model.hpp>

#include <cstdlib>

#if defined(EXPORTS)
extern "C" __attribute__((visibility("default"))) int chatter() { return 1; }
#endif

namespace {
using namespace scree;

#if defined(STARTS)
const int started = setenv("SCREE_VET_STARTED", "yes", 1);
#elif defined(DIES)
struct Dies {
  Dies() { std::abort(); }
} dies;
#endif

struct Small {
  double kn, cn;

  static void describe(Properties<Small>& p) {
    p.number("kn", &Small::kn, "N/m", "normal stiffness").above(0);
    p.number("cn", &Small::cn, "1", "share of critical damping").at_least(0);
  }
  void law(const Contact& c, Response& r) const {
    r.force = (max(0.0, -kn * c.gap) - c.dashpot(cn, c.gap < 0 ? kn : 0.0) * c.opening()) * c.normal;
  }
  Stiffness stiffness(const Contact&) const { return {.normal = kn, .dashpot = cn}; }
};

}  // namespace

SCREE_CONTACT_MODEL(Small, "small", "1.0.0")
