#include <scree/process.hpp>

#include <map>

#include "support/catch.hpp"
#include "support/opened.hpp"

namespace {

using namespace scree;

/// Moves a wall until its force is right, and counts its calls in saved state.
struct Servo {
  static constexpr uint32_t every = 5;
  std::string wall;
  double force = 0, gain = 1;
  scree::Wall held;
  struct State {
    double calls;
    Vec3 last;
  };

  static void describe(Settings<Servo>& s) {
    s.text("wall", &Servo::wall, "name of the wall").required();
    s.number("force", &Servo::force, "N", "force to reach");
    s.number("gain", &Servo::gain, "m/(N s)", "velocity per missing force").above(0);
  }
  void prepare(const Host& host) { held = host.wall(wall); }
  void step(Step& step, State& state) {
    scree_wall_view& view = step.host.view(held);
    view.velocity[2] = gain * (force - view.force[2]);
    state.calls += 1;
    state.last = {view.force[0], view.force[1], view.force[2]};
    step.host.publish("missing", force - view.force[2] + step.host.read("offset"));
  }
};

/// Reads two columns in `ball`, and turns only where there is spin.
struct Wind {
  static constexpr Effect effect = Effect::adds_force;
  double speed = 3;
  std::string note = "not trivially copyable";

  static void describe(Settings<Wind>& s) { s.number("speed", &Wind::speed, "m/s", "of the air"); }
  void ball(const Position& x, Velocity v, const Radius& r, Force& f) const { f.x += r * (speed - v.x) + x.z; }
  void rotation(Spin& w, const Inertia& inertia) const { w *= inertia; }
};

struct World {
  scree_wall_view view{};
  std::map<std::string, double> published;
  scree_host host{sizeof(scree_host), 0, this, &wall, &wall_view, &publish, nullptr, nullptr, &read, nullptr};

  static int wall(void*, const char* name, uint32_t* handle) {
    return std::string(name) == "top" ? (*handle = 4, 1) : 0;
  }
  static scree_wall_view* wall_view(void* self, uint32_t handle) {
    return handle == 4 ? &static_cast<World*>(self)->view : nullptr;
  }
  static void publish(void* self, const char* name, double value) {
    static_cast<World*>(self)->published[name] = value;
  }
  static int read(void*, const char* name, double* value) {
    return std::string(name) == "offset" ? (*value = 100, 1) : 0;
  }
};

const scree_process& table_of(const scree_component& component) {
  REQUIRE(component.kind == SCREE_PROCESS);
  return *static_cast<const scree_process*>(component.table());
}

}  // namespace

TEST_CASE("a model process reads and moves walls, publishes and keeps state", "[sdk]") {
  constexpr scree_component component = scree::process<Servo>("servo", "1.2.3", "a servo");  // constant data
  const scree_process& process = table_of(component);
  CHECK(process.every == 5);
  CHECK(process.state_words == 4);
  CHECK(process.need_count == 0);
  CHECK(process.rows[0] == nullptr);
  CHECK(process.damping == nullptr);
  support::Object servo(process.object);
  World world;
  support::Refused refused;
  REQUIRE(servo.text("wall", "tpo") == "");
  CHECK(process.prepare(servo.self(), &world.host, &refused.table) != 0);
  CHECK(std::string(refused.text) == "there is no wall 'tpo'");
  REQUIRE(servo.text("wall", "top") == "");
  REQUIRE(servo.number("force", 10) == "");
  REQUIRE(servo.number("gain", 0.5) == "");
  REQUIRE(process.prepare(servo.self(), &world.host, &refused.table) == 0);
  world.view.force[2] = 4;
  double state[4] = {1, 0, 0, 0};
  const scree_step step{sizeof(scree_step), 0, 20, 0.5, 0.1, nullptr, state, &world.host};
  REQUIRE(process.step(servo.self(), &step, &refused.table) == 0);
  CHECK(world.view.velocity[2] == 3);
  CHECK(world.published.at("missing") == 106);
  CHECK(state[0] == 2);
  CHECK(state[3] == 4);
}

TEST_CASE("the parameters of ball and rotation declare the columns", "[sdk]") {
  const scree_process& process = table_of(scree::process<Wind>("wind", "1"));
  const std::vector<std::pair<uint32_t, uint32_t>> expected{{SCREE_POSITION, SCREE_READ},
                                                            {SCREE_VELOCITY, SCREE_READ},
                                                            {SCREE_RADIUS, SCREE_READ},
                                                            {SCREE_FORCE, SCREE_READ | SCREE_WRITE},
                                                            {SCREE_SPIN, SCREE_READ | SCREE_WRITE | SCREE_OPTIONAL},
                                                            {SCREE_INERTIA, SCREE_READ | SCREE_OPTIONAL}};
  std::vector<std::pair<uint32_t, uint32_t>> needs;
  for (uint32_t k = 0; k < process.need_count; ++k)
    needs.emplace_back(process.needs[k].column, process.needs[k].access);
  CHECK(needs == expected);
  CHECK(process.flags == SCREE_ADDS_FORCE);
  CHECK(process.step == nullptr);

  // 3 + 3 + 1 + 3 words of ball, 3 + 1 of rotation; two rows.
  double word[14][2];
  double* pointer[14];
  for (int k = 0; k < 14; ++k) pointer[k] = word[k], word[k][0] = k, word[k][1] = 10 * k;
  scree_rows rows{};
  rows.n = 2;
  rows.word = pointer;
  support::Object wind(process.object);
  process.rows[0](wind.self(), &rows);
  CHECK(word[7][0] == 7 + 6 * (3.0 - 3) + 2);
  CHECK(word[7][1] == 70 + 60 * (3.0 - 30) + 20);
  CHECK(word[3][0] == 3);  // a column taken by value is not written back
  CHECK(word[11][1] == 110 * 130.0);
}
