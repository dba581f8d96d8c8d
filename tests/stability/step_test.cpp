// What docs/stability.md says of the automatic step, against closed forms. Critical steps of networks of equal balls,
// mass m, stiffness kn and ks, rotation included: all balls of a lattice spinning the same way give
// w^2 = (10 Z/3) ks/m with Z neighbours, a pair 2 kn/m and 7 ks/m, a ball on a wall kn/m and 3.5 ks/m.
#include <cmath>

#include "core/contact/network_bound.hpp"
#include "stability/lab.hpp"
#include "support/catch.hpp"

using namespace scree::core;

namespace {

constexpr double kn = 1e5, mass = 2500 * 4.0 / 3 * 3.14159265358979323846 * 1e-6;

std::string contacts(double ratio, const std::string& more = "") {
  return "contacts:\n  - {name: all, between: [balls, [balls, walls]], model: linear, kn: 1e5, ks: " +
         std::to_string(kn * ratio) + ", fric: 0.5" + more + "}\n";
}

std::string lattice(const std::string& kind, const std::string& edge, double ratio) {
  return "scree: 1\nvars: {edge: \"" + edge +
         "\"}\ncell: {low: [0, 0, 0], high: [edge, edge, edge], periodic: [x, y, z]}\n"
         "balls:\n  crystal: {generator: lattice, kind: " +
         kind + ", radius: 0.01, fit: false, box: [[0, 0, 0], [edge, edge, edge]], density: 2500}\n" + contacts(ratio) +
         "stages:\n  - go: [cycle: 1]\n";
}

std::string on_floor(double ratio, const std::string& more = "", const std::string& processes = "") {
  return "scree: 1\nwalls:\n  floor: {wall: plane, point: [0, 0, 0], normal: [0, 0, 1]}\n"
         "balls:\n  one: {generator: file, path: balls.csv, density: 2500}\n" +
         contacts(ratio, more) + processes + "stages:\n  - go: [cycle: 1]\n";
}

/// The bound over sqrt(m/kn), without the safety share.
double bound(lab::Lab& here, const std::string& scene) {
  const auto simulation = here.make(scene);
  Engine& engine = simulation->engine;
  engine.forces();
  NetworkQuery query;
  query.links.margin = 1e-6;
  query.sweeps = 20;
  query.local_damping = engine.local_damping();
  const StepBound network =
      network_bound(engine.contacts, engine.balls, engine.walls, engine.cell, query, engine.team).network;
  CHECK(engine.step.bound().step <= network.step);
  CHECK(engine.clock.dt <= 0.95 * network.step);
  CHECK(engine.clock.dt > 0.95 * engine.step.bound().step * (1 - 1.0 / 32));
  return network.step / std::sqrt(mass / kn);
}

}  // namespace

TEST_CASE("step OK: the bound is the critical step of a pair in any direction") {
  lab::Lab here;
  for (const double ratio : {0.0, 0.2, 0.4, 1.0})
    for (const std::string at : {"0.02,0,0", "0.011547005383792516,0.011547005383792516,0.011547005383792516"}) {
      write_text(here.folder() / "balls.csv", "x,y,z,radius\n0,0,0,0.01\n" + at + ",0.01\n");
      const std::string scene = "scree: 1\nballs:\n  pair: {generator: file, path: balls.csv, density: 2500}\n" +
                                contacts(ratio) + "stages:\n  - go: [cycle: 1]\n";
      INFO("ks/kn " << ratio << ", at " << at);
      CHECK(bound(here, scene) == Approx(2 / std::sqrt(std::max(2.0, 7 * ratio))).epsilon(1e-9));
    }
}

TEST_CASE("step OK: the bound is the critical step of a ball on a wall, with dashpots and local damping") {
  lab::Lab here;
  write_text(here.folder() / "balls.csv", "x,y,z,radius\n0,0,0.01,0.01\n");
  for (const double ratio : {0.0, 0.2, 0.4, 1.0}) {
    INFO("ks/kn " << ratio);
    CHECK(bound(here, on_floor(ratio)) == Approx(2 / std::sqrt(std::max(1.0, 3.5 * ratio))).epsilon(1e-9));
  }
  // A dashpot of share xi that uses the velocity of half a step before: (2/w)(sqrt(1 + xi^2) - xi).
  for (const double xi : {0.1, 0.5, 1.0}) {
    INFO("xi " << xi);
    CHECK(bound(here, on_floor(0, ", dp_nratio: " + std::to_string(xi))) ==
          Approx(2 * (std::sqrt(1 + xi * xi) - xi)).epsilon(1e-9));
  }
  // Local damping multiplies the force of a slowing ball by 1 + factor.
  CHECK(bound(here, on_floor(0, "", "processes:\n  damping: {process: local_damping, factor: 0.7}\n")) ==
        Approx(2 / std::sqrt(1.7)).epsilon(1e-9));
}

TEST_CASE("step OK: the numbering of balls does not matter to the bound") {
  // Four balls that touch each other: the contacts of each lie on one side of it, so that translation and rotation
  // couple, and the sign with which each enters decides the eigenvalue.
  lab::Lab here;
  const char* const places[] = {"0,0,0", "0.02,0,0", "0.01,0.017320508075688773,0",
                                "0.01,0.0057735026918962576,0.016329931618554521"};
  const int orders[][4] = {{0, 1, 2, 3}, {3, 2, 1, 0}, {1, 3, 0, 2}, {0, 3, 1, 2}, {2, 0, 3, 1}};
  double first = 0;
  for (const auto& order : orders) {
    std::string text = "x,y,z,radius\n";
    for (const int k : order) text += std::string(places[k]) + ",0.01\n";
    write_text(here.folder() / "balls.csv", text);
    const double value = bound(here, "scree: 1\nballs:\n  four: {generator: file, path: balls.csv, density: 2500}\n" +
                                         contacts(0.6) + "stages:\n  - go: [cycle: 1]\n");
    if (first == 0) first = value;
    CHECK(value == Approx(first).epsilon(1e-9));
  }
}

TEST_CASE("step OK: the bound is the critical step of the cubic lattices with rotation") {
  lab::Lab here;
  struct Kind {
    const char *name, *edge;
    double neighbours, normal;  ///< critical step for ks = 0, over sqrt(m/kn)
  };
  double worst = 0;
  for (const Kind& kind : {Kind{"sc", "4*0.02", 6, 1.0}, Kind{"bcc", "3*2/sqrt(3)*0.02", 8, std::sqrt(0.75)},
                           Kind{"fcc", "3*sqrt(2)*0.02", 12, std::sqrt(0.5)}})
    for (const double ratio : {0.0, 0.4, 2.0 / 3, 1.0}) {
      const double exact =
          ratio == 0 ? kind.normal : std::min(kind.normal, 2 / std::sqrt(10 * kind.neighbours / 3 * ratio));
      const double value = bound(here, lattice(kind.name, kind.edge, ratio));
      INFO(kind.name << ", ks/kn " << ratio);
      CHECK(value == Approx(exact).epsilon(1e-5));
      worst = std::max(worst, std::fabs(value / exact - 1));
    }
  lab::measured("step", "bound against closed forms: pair and ball on a wall 1e-9, SC BCC FCC at four ks/kn within " +
                            lab::number(worst));
}
