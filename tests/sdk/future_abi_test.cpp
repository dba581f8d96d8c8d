// A deliberate change of the ABI: this program is compiled with a header whose structs have two more fields at the end
// (tests/sdk/old_abi.cmake makes it from today's). A library built against the header of 0.1 must load and run.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include "core/plugin/catalogue.hpp"
#include "core/plugin/first_size.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"

namespace {

using scree::core::Catalogue;
using scree::core::Component;
using scree::core::Kind;

static_assert(SCREE_ABI_MINOR == 999);
static_assert(sizeof(scree_contact_model) >= scree::core::first_size<scree_contact_model> + 2 * sizeof(double));
static_assert(sizeof(scree_property) > scree::core::first_size<scree_property>);

const double unread = std::numeric_limits<double>::quiet_NaN();  // of fields that the old library does not know

Catalogue old_catalogue() { return Catalogue({{std::filesystem::path(support::binary_dir()) / "tests" / "old"}, {}}); }

/// Fields that came later read as zero, in the table and in each of its properties.
template <class T>
void check_later_fields(const T& table, const Component& component) {
  CHECK(table.struct_size == sizeof(T));
  CHECK(table.future[0] == 0);
  CHECK(table.future[1] == 0);
  for (uint32_t k = 0; k < component.property_count(); ++k) {
    CHECK(component.properties()[k].struct_size == sizeof(scree_property));
    CHECK(component.properties()[k].future[1] == 0);
  }
}

scree_value number(const double& value) {
  scree_value v{};
  v.struct_size = sizeof v;
  v.type = SCREE_NUMBER;
  v.numbers = &value;
  v.rows = v.columns = 1;
  v.future[0] = unread;
  return v;
}

}  // namespace

TEST_CASE("a contact model of ABI 0.1 runs under a header that has grown", "[abi]") {
  Catalogue catalogue = old_catalogue();
  const Component& component = catalogue.open(Kind::contact_model, "old");
  const scree_contact_model& model = component.contact_model();
  check_later_fields(model, component);
  REQUIRE(component.property_count() == 2);
  CHECK(std::string(component.properties()[1].name) == "pull");  // found by the library's own stride
  CHECK(model.normal_only[0] == nullptr);
  CHECK(model.mixed == nullptr);  // came after 0.1
  double rule[2] = {1000, 2}, zero = 0, one = 1, gap = -0.01, deepest = 0.004, f[3], tangent;
  double* state[1] = {&deepest};
  scree_batch batch{};
  batch.struct_size = sizeof batch;
  batch.n = 1;
  batch.nx = batch.ny = &zero;
  batch.nz = &one;
  batch.gap = &gap;
  batch.state = state;
  batch.fx = &f[0], batch.fy = &f[1], batch.fz = &f[2];
  batch.future[0] = batch.future[1] = unread;
  CHECK(model.uniform[0](rule, &batch) == 0);
  CHECK(f[2] == Approx(8));
  CHECK(deepest == 0.01);
  scree_stiffness out{};
  out.struct_size = sizeof out;
  out.n = 1;
  out.normal = &tangent;
  model.stiffness(rule, &batch, &out);
  CHECK(tangent == 1000);
}

TEST_CASE("a wall of ABI 0.1 runs under a header that has grown", "[abi]") {
  Catalogue catalogue = old_catalogue();
  const Component& component = catalogue.open(Kind::wall, "old");
  const scree_wall& wall = component.wall();
  check_later_fields(wall, component);
  CHECK(std::string(component.properties()[1].name) == "height");
  void* self = wall.object.create();
  const double height = 2, x = 0, z = 2.5, reach = 1;
  const scree_value value = number(height);
  REQUIRE(wall.object.set(self, 1, &value, nullptr) == 0);
  uint32_t ball, patch;
  double n[3], distance;
  const scree_touches out{sizeof(scree_touches), 1, &ball, &patch, &n[0], &n[1], &n[2], &distance, {unread, unread}};
  CHECK(wall.touch(self, 1, &x, &x, &z, &reach, &out) == 1);
  CHECK(distance == 0.5);
  CHECK(n[2] == -1);
  wall.object.destroy(self);
}

TEST_CASE("a generator of ABI 0.1 runs under a header that has grown", "[abi]") {
  Catalogue catalogue = old_catalogue();
  const Component& component = catalogue.open(Kind::generator, "old");
  const scree_generator& generator = component.generator();
  check_later_fields(generator, component);
  REQUIRE(component.properties()[0].column_count == 2);
  CHECK(std::string(component.properties()[0].columns[1].name) == "radius");
  CHECK(component.properties()[0].columns[1].word == 1);
  CHECK(component.properties()[0].columns[1].future[0] == 0);
  void* self = generator.object.create();
  const double cells[4] = {1, 0.5, 3, 0.25};
  scree_value value = number(cells[0]);
  value.type = SCREE_TABLE;
  value.rows = value.columns = 2;
  REQUIRE(generator.object.set(self, 0, &value, nullptr) == 0);
  // The old library hands over its own, shorter scree_ball: only its fields may be read.
  struct Host {
    std::vector<double> radii;
    static int ball(void* host, const scree_ball* ball) {
      CHECK(ball->struct_size == offsetof(scree_ball, group) + sizeof(scree_ball::group));
      static_cast<Host*>(host)->radii.push_back(ball->radius);
      return 1;
    }
  } host;
  scree_sink sink{};
  sink.struct_size = sizeof sink;
  sink.self = &host;
  sink.ball = Host::ball;
  CHECK(generator.generate(self, &sink, nullptr) == 0);
  CHECK(host.radii == std::vector<double>{0.5, 0.25});
  generator.object.destroy(self);
}

TEST_CASE("a process of ABI 0.1 runs under a header that has grown", "[abi]") {
  Catalogue catalogue = old_catalogue();
  const Component& component = catalogue.open(Kind::process, "old");
  const scree_process& process = component.process();
  check_later_fields(process, component);
  CHECK(process.damping == nullptr);
  void* self = process.object.create();
  const double gravity = 10;
  const scree_value value = number(gravity);
  REQUIRE(process.object.set(self, 0, &value, nullptr) == 0);
  double mass = 2, force[3] = {0, 0, 5}, state = 6, published = 0;
  double* word[4] = {&mass, &force[0], &force[1], &force[2]};
  const scree_rows rows{sizeof(scree_rows), 1, 0, 0, 0, 0.1, word, nullptr, {unread, unread}};
  process.rows[0](self, &rows);
  CHECK(force[2] == -15);
  scree_host host{};
  host.struct_size = sizeof host;
  host.self = &published;
  host.publish = [](void* to, const char*, double calls) { *static_cast<double*>(to) = calls; };
  const scree_step step{sizeof(scree_step), 0, 1, 0.1, 0.1, nullptr, &state, &host, {unread, unread}};
  CHECK(process.step(self, &step, nullptr) == 0);
  CHECK(state == 7);
  CHECK(published == 7);
  process.object.destroy(self);
}

TEST_CASE("a writer of ABI 0.1 runs under a header that has grown", "[abi]") {
  Catalogue catalogue = old_catalogue();
  const Component& component = catalogue.open(Kind::writer, "old");
  const scree_writer& writer = component.writer();
  check_later_fields(writer, component);
  CHECK(writer.save == nullptr);
  void* self = writer.object.create();
  std::string text;
  const scree_files files{sizeof(scree_files),
                          0,
                          &text,
                          [](void* to, const char* name, const void* bytes, uint64_t size) {
                            *static_cast<std::string*>(to) +=
                                std::string(name) + ": " + std::string(static_cast<const char*>(bytes), size);
                            return 1;
                          },
                          nullptr,
                          {unread, unread}};
  REQUIRE(writer.open(self, "line", &files, nullptr) == 0);
  const char* name = "load";
  const double load = 2.5;
  scree_frame frame{};
  frame.struct_size = sizeof frame;
  frame.index = 3;
  frame.ball_count = 4;
  frame.quantity_count = 1;
  frame.quantity_names = &name;
  frame.quantities = &load;
  CHECK(writer.frame(self, &frame, &files) == 0);
  CHECK(text == "line.txt: 3 4 balls, load 2.5\n");
  writer.object.destroy(self);
}
