#include <cmath>

#include "support/catch.hpp"
#include "support/opened.hpp"

namespace {

using support::Object;
using support::opened;
using support::Vector;

struct Touch {
  uint32_t ball, patch;
  Vector normal;
  double distance;
};

/// All touches of one call, with room for `capacity` of them.
std::vector<Touch> touches(const scree_wall& wall, const Object& object, const std::vector<Vector>& centre,
                           double reach, uint32_t capacity = 64, uint32_t* total = nullptr) {
  std::vector<double> x, y, z, reaches(centre.size(), reach);
  for (const Vector& c : centre) x.push_back(c[0]), y.push_back(c[1]), z.push_back(c[2]);
  std::vector<uint32_t> ball(capacity), patch(capacity);
  std::vector<double> nx(capacity), ny(capacity), nz(capacity), distance(capacity);
  const scree_touches out{sizeof(scree_touches), capacity, ball.data(), patch.data(), nx.data(), ny.data(), nz.data(),
                          distance.data()};
  const uint32_t count = wall.touch(object.self(), static_cast<uint32_t>(centre.size()), x.data(), y.data(), z.data(),
                                    reaches.data(), &out);
  if (total != nullptr) *total = count;
  std::vector<Touch> list;
  for (uint32_t k = 0; k < std::min(count, capacity); ++k)
    list.push_back({ball[k], patch[k], {nx[k], ny[k], nz[k]}, distance[k]});
  return list;
}

std::vector<std::vector<double>> outline(const scree_wall& wall, const Object& object, Vector low, Vector high) {
  std::vector<std::vector<double>> faces;
  wall.outline(object.self(), low.data(), high.data(), &faces, [](void* sink, uint32_t corners, const double* xyz) {
    static_cast<std::vector<std::vector<double>>*>(sink)->emplace_back(xyz, xyz + 3 * corners);
  });
  return faces;
}

/// Twice the area vector of a polygon, by the shoelace formula: length twice the area, along its normal.
Vector area_vector(const std::vector<double>& p) {
  Vector sum{};
  for (std::size_t k = 0; k < p.size(); k += 3) {
    const std::size_t m = (k + 3) % p.size();
    sum[0] += p[k + 1] * p[m + 2] - p[k + 2] * p[m + 1];
    sum[1] += p[k + 2] * p[m] - p[k] * p[m + 2];
    sum[2] += p[k] * p[m + 1] - p[k + 1] * p[m];
  }
  return sum;
}

Object& box(Object& object, const std::vector<std::string>& open) {
  REQUIRE(object.vector("low", {0, 0, 0}) == "");
  REQUIRE(object.vector("high", {1, 2, 3}) == "");
  REQUIRE(object.texts("open", open) == "");
  REQUIRE(object.check() == "");
  return object;
}

}  // namespace

TEST_CASE("plane: signed distance, one-sided, normal from ball to wall", "[plugin]") {
  const auto& wall = opened<scree_wall>("wall", "plane");
  CHECK((wall.flags & SCREE_WALL_FLAT) != 0);
  Object plane(wall.object);
  REQUIRE(plane.vector("point", {0, 0, 1}) == "");
  REQUIRE(plane.vector("normal", {0, 0, 5}) == "");
  REQUIRE(plane.check() == "");
  const auto list = touches(wall, plane, {{3, 4, 1.5}, {0, 0, 2}, {0, 0, 0.5}, {0, 0, 0}, {9, 9, 1}}, 1);
  REQUIRE(list.size() == 3);
  CHECK(list[0].ball == 0);
  CHECK(list[0].distance == 0.5);
  CHECK(list[0].normal == Vector{0, 0, -1});
  CHECK(list[0].patch == 0);
  CHECK(list[1].ball == 2);  // half a reach behind: still pushed back
  CHECK(list[1].distance == -0.5);
  CHECK(list[2].ball == 4);  // centre on the plane
  CHECK(list[2].distance == 0);
  CHECK(list[2].normal == Vector{0, 0, -1});
}

TEST_CASE("plane: an oblique normal of any length", "[plugin]") {
  const auto& wall = opened<scree_wall>("wall", "plane");
  for (const double scale : {1.0, 1e-200, 1e200}) {
    Object plane(wall.object);
    REQUIRE(plane.vector("point", {1, 1, 1}) == "");
    REQUIRE(plane.vector("normal", {3 * scale, 0, 4 * scale}) == "");
    REQUIRE(plane.check() == "");
    // (3, 0, 4)/5 . (2, 7, 1) = 2
    const auto list = touches(wall, plane, {{3, 8, 2}}, 2.5);
    REQUIRE(list.size() == 1);
    CHECK(list[0].distance == Approx(2).epsilon(1e-15));
    CHECK(list[0].normal[0] == Approx(-0.6).epsilon(1e-15));
    CHECK(list[0].normal[2] == Approx(-0.8).epsilon(1e-15));
  }
  Object none(wall.object);
  REQUIRE(none.vector("normal", {0, 0, 0}) == "");
  CHECK(none.check().find("'normal' is zero") == 0);
}

TEST_CASE("plane: its outline is its cut through the box, seen from the balls", "[plugin]") {
  const auto& wall = opened<scree_wall>("wall", "plane");
  Object plane(wall.object);
  REQUIRE(plane.vector("point", {0.5, 0.5, 0.5}) == "");
  REQUIRE(plane.vector("normal", {1, 1, 1}) == "");
  REQUIRE(plane.check() == "");
  // Through the centre of the unit cube across its diagonal: a regular hexagon of side 1/sqrt 2, area 3 sqrt 3/4.
  const auto faces = outline(wall, plane, {0, 0, 0}, {1, 1, 1});
  REQUIRE(faces.size() == 1);
  CHECK(faces[0].size() == 18);
  const Vector twice = area_vector(faces[0]);
  for (std::size_t k = 0; k < 3; ++k) CHECK(twice[k] == Approx(2 * 0.75).epsilon(1e-12));
  CHECK(outline(wall, plane, {5, 5, 5}, {6, 6, 6}).empty());
}

TEST_CASE("plane: more touches than room are counted", "[plugin]") {
  const auto& wall = opened<scree_wall>("wall", "plane");
  Object plane(wall.object);
  REQUIRE(plane.vector("normal", {0, 0, 1}) == "");
  REQUIRE(plane.check() == "");
  uint32_t total = 0;
  CHECK(touches(wall, plane, std::vector<Vector>(9, Vector{0, 0, 0.1}), 1, 4, &total).size() == 4);
  CHECK(total == 9);
}

TEST_CASE("box: each closed face touches inwards with its own patch", "[plugin]") {
  const auto& wall = opened<scree_wall>("wall", "box");
  Object object(wall.object);
  box(object, {});
  const std::vector<Vector> centre{{0.1, 1, 1.5},   {0.9, 1, 1.5}, {0.5, 0.1, 1.5},
                                   {0.5, 1.9, 1.5}, {0.5, 1, 0.1}, {0.5, 1, 2.9}};
  const auto list = touches(wall, object, centre, 0.2);
  REQUIRE(list.size() == 6);
  for (uint32_t f = 0; f < 6; ++f) {
    CHECK(list[f].ball == f);
    CHECK(list[f].patch == f);
    CHECK(list[f].distance == Approx(0.1).epsilon(1e-14));
    Vector normal{};
    normal[f / 2] = f % 2 == 0 ? -1 : 1;
    CHECK(list[f].normal == normal);
  }
  CHECK(wall.area(object.self()) == 22);                                // 2 (1*2 + 2*3 + 3*1)
  CHECK(touches(wall, object, {{0.05, 0.05, 0.05}}, 0.2).size() == 3);  // a corner of three closed faces
  const auto centred = touches(wall, object, {{0, 1, 1.5}}, 0.2);       // centre on the face
  REQUIRE(centred.size() == 1);
  CHECK(centred[0].distance == 0);
  CHECK(centred[0].normal == Vector{-1, 0, 0});
  const auto behind = touches(wall, object, {{-0.1, 1, 1.5}}, 0.2);
  REQUIRE(behind.size() == 1);
  CHECK(behind[0].distance == Approx(-0.1));
  CHECK(touches(wall, object, {{-0.2, 1, 1.5}}, 0.2).empty());
}

TEST_CASE("box: the rim of an open face", "[plugin]") {
  const auto& wall = opened<scree_wall>("wall", "box");
  Object object(wall.object);
  box(object, {"top"});
  // Above the left wall: the nearest point of the edge x = 0, z = 3.
  auto list = touches(wall, object, {{0.03, 1, 3.04}}, 0.2);
  REQUIRE(list.size() == 1);
  CHECK(list[0].patch >= 6);
  CHECK(list[0].patch < 18);
  CHECK(list[0].distance == Approx(0.05).epsilon(1e-12));
  CHECK(list[0].normal[0] == Approx(-0.6).epsilon(1e-12));
  CHECK(list[0].normal[2] == Approx(-0.8).epsilon(1e-12));
  CHECK(touches(wall, object, {{0.5, 1, 3.04}}, 0.2).empty());  // in the opening
  // Outside the box, beyond the opening and near a corner of the rim: one touch, with the corner, sqrt(1+4+4) = 3.
  list = touches(wall, object, {{-0.01, -0.02, 3.02}}, 0.2);
  REQUIRE(list.size() == 1);
  CHECK(list[0].patch >= 18);
  CHECK(list[0].distance == Approx(0.03).epsilon(1e-12));
  // Inside the corner, above both walls: an edge each, no corner.
  list = touches(wall, object, {{0.01, 0.02, 3.02}}, 0.2);
  REQUIRE(list.size() == 2);
  CHECK(list[0].patch < 18);
  CHECK(list[1].patch < 18);
  CHECK(list[0].patch != list[1].patch);
  // Exactly level with the rim the face still acts, and alone.
  list = touches(wall, object, {{0.1, 1, 3}}, 0.2);
  REQUIRE(list.size() == 1);
  CHECK(list[0].patch == 0);
  CHECK(wall.area(object.self()) == 20);
}

TEST_CASE("box: a single plate is a rectangle with edges and corners all round", "[plugin]") {
  const auto& wall = opened<scree_wall>("wall", "box");
  Object object(wall.object);
  box(object, {"left", "right", "front", "back", "top"});
  // Distance to the rectangle [0,1] x [0,2] at z = 0, by brute force over its nearest point.
  for (int k = 0; k < 4000; ++k) {
    const Vector c{-0.5 + 2 * std::fmod(k * 0.618034, 1.0), -0.5 + 3 * std::fmod(k * 0.754878, 1.0),
                   0.4 * std::fmod(k * 0.569840, 1.0) + 1e-3};
    const Vector nearest{std::min(std::max(c[0], 0.0), 1.0), std::min(std::max(c[1], 0.0), 2.0), 0};
    const double distance = std::hypot(c[0] - nearest[0], c[1] - nearest[1], c[2]);
    const auto list = touches(wall, object, {c}, 0.3);
    REQUIRE(list.size() == (distance < 0.3 ? 1 : 0));
    if (list.empty()) continue;
    REQUIRE(list[0].distance == Approx(distance).epsilon(1e-12));
    for (std::size_t a = 0; a < 3; ++a)
      REQUIRE(c[a] + list[0].normal[a] * list[0].distance == Approx(nearest[a]).margin(1e-12));
  }
}

TEST_CASE("box: settings that make no box are refused", "[plugin]") {
  const auto& wall = opened<scree_wall>("wall", "box");
  Object object(wall.object);
  CHECK(object.texts("open", {"lid"}) == "'open' is 'lid', but must be one of: left right front back bottom top");
  REQUIRE(object.vector("low", {0, 0, 1}) == "");
  REQUIRE(object.vector("high", {1, 1, 1}) == "");
  CHECK(object.check() == "'low' must lie below 'high': along z they are 1 and 1");
  REQUIRE(object.vector("high", {1, 1, 2}) == "");
  REQUIRE(object.texts("open", {"left", "right", "front", "back", "bottom", "top"}) == "");
  CHECK(object.check().find("all six faces are open") == 0);
}

TEST_CASE("box: outlines face inwards and have the area", "[plugin]") {
  const auto& wall = opened<scree_wall>("wall", "box");
  Object object(wall.object);
  box(object, {"front", "top"});
  double sum = 0;
  const auto faces = outline(wall, object, {0, 0, 0}, {1, 1, 1});
  CHECK(faces.size() == 4);
  for (const auto& face : faces) {
    const Vector twice = area_vector(face);
    sum += std::hypot(twice[0], twice[1], twice[2]) / 2;
    // Inward: from the face's first corner towards the middle of the box (0.5, 1, 1.5).
    CHECK(twice[0] * (0.5 - face[0]) + twice[1] * (1 - face[1]) + twice[2] * (1.5 - face[2]) > 0);
  }
  CHECK(sum == Approx(wall.area(object.self())).epsilon(1e-14));
}
