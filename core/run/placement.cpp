#include "core/run/placement.hpp"

#include <algorithm>
#include <cmath>

namespace scree::core {

namespace {

constexpr double pi = 3.141592653589793238462643383279503;

bool all_finite(const double v[3]) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

bool any(const double v[3]) { return v[0] != 0 || v[1] != 0 || v[2] != 0; }

std::string at(const scree_ball& ball) {
  char text[120];
  std::snprintf(text, sizeof text, "ball at (%.6g, %.6g, %.6g) m with radius %.6g m", ball.position[0],
                ball.position[1], ball.position[2], ball.radius);
  return text;
}

}  // namespace

Placement::Placement(Simulation& simulation, const BallSet& set)
    : simulation_(simulation),
      set_(set),
      random_(simulation.scene.seed, "generator/" + set.name),
      random_table_(random_.table()) {
  for (int axis = 0; axis < 3; ++axis) periodic_[axis] = simulation.engine.cell.periodic[axis];
}

scree_sink Placement::sink() {
  const PeriodicCell& cell = simulation_.engine.cell;
  const bool has_cell = simulation_.scene.cell.has_value();
  return {sizeof(scree_sink),
          0,
          this,
          ball,
          try_ball,
          &random_table_,
          has_cell ? cell.low : nullptr,
          has_cell ? cell.high : nullptr,
          has_cell ? periodic_ : nullptr,
          warn};
}

bool Placement::in_use(uint64_t id) {
  const Balls& balls = simulation_.engine.balls;
  if (id >= balls.next_id) return false;
  if (ids_.empty())
    for (std::size_t row = 0; row < balls.size(); ++row) ids_.insert(balls.id()[row]);
  return ids_.contains(id);
}

std::string Placement::wrong(const scree_ball& b) {
  if (!all_finite(b.position)) return "a ball has a position that is not finite";
  if (!(b.radius > 0) || !std::isfinite(b.radius)) return at(b) + ": the radius must be positive";
  const bool own = (b.given & SCREE_BALL_DENSITY) != 0;
  if (!own && !set_.density) return "the set has no density and the generator gives none: add 'density' to the set";
  const double density = own ? b.density : *set_.density;
  if (!(density > 0) || !std::isfinite(density)) return at(b) + ": the density must be positive";
  if ((b.given & SCREE_BALL_VELOCITY) != 0 && !all_finite(b.velocity)) return at(b) + ": its velocity is not finite";
  if ((b.given & SCREE_BALL_SPIN) != 0 && !all_finite(b.spin)) return at(b) + ": its spin is not finite";
  if ((b.given & SCREE_BALL_ID) != 0 && in_use(b.id))
    return at(b) + ": id " + std::to_string(b.id) + " is in use already; give every ball its own id";
  if ((b.given & SCREE_BALL_ID) != 0 && b.id == 0) return at(b) + ": id 0 is not allowed, ids start at 1";
  return "";
}

int Placement::ball(void* self, const scree_ball* ball) {
  auto& here = *static_cast<Placement*>(self);
  here.refusal_ = here.wrong(*ball);
  if (!here.refusal_.empty()) return 0;
  here.add(*ball);
  return 1;
}

int Placement::try_ball(void* self, const scree_ball* ball) {
  auto& here = *static_cast<Placement*>(self);
  here.refusal_ = here.wrong(*ball);
  if (!here.refusal_.empty()) return 0;
  if (!here.inside_cell(*ball) || !here.free_of_others(*ball) || !here.free_of_walls(*ball)) return 0;
  here.add(*ball);
  return 1;
}

void Placement::warn(void* self, const char* message) {
  auto& here = *static_cast<Placement*>(self);
  here.simulation_.warn("balls '" + here.set_.name + "': " + message);
}

bool Placement::inside_cell(const scree_ball& b) const {
  if (!simulation_.scene.cell) return true;
  const PeriodicCell& cell = simulation_.engine.cell;
  for (int axis = 0; axis < 3; ++axis) {
    const double margin = cell.periodic[axis] ? 0.0 : b.radius;
    if (b.position[axis] - margin < cell.low[axis] || b.position[axis] + margin > cell.high[axis]) return false;
  }
  return true;
}

bool Placement::free_of_walls(const scree_ball& b) const {
  for (const Wall& wall : simulation_.engine.walls) {
    const auto local = wall.to_frame({b.position[0], b.position[1], b.position[2]});
    uint32_t which, patch;
    double nx, ny, nz, distance;
    const scree_touches touches{sizeof(scree_touches), 1, &which, &patch, &nx, &ny, &nz, &distance};
    if (wall.touch(1, &local[0], &local[1], &local[2], &b.radius, touches) > 0) return false;
  }
  return true;
}

// Cells are keyed by their whole-number place; two places that share a key only cost a distance test.
uint64_t Placement::key(const double position[3], const int64_t offset[3]) const {
  uint64_t hash = 1469598103934665603ULL;
  for (int axis = 0; axis < 3; ++axis) {
    const double place = std::floor(position[axis] / edge_);
    const auto whole = std::abs(place) < 9e15 ? static_cast<int64_t>(place) : 0;
    hash = (hash ^ static_cast<uint64_t>(whole + offset[axis])) * 1099511628211ULL;
  }
  return hash;
}

void Placement::index(std::size_t row) {
  const Balls& balls = simulation_.engine.balls;
  const double position[3] = {balls[Column::x][row], balls[Column::y][row], balls[Column::z][row]};
  const int64_t here[3] = {0, 0, 0};
  cells_[key(position, here)].push_back(static_cast<uint32_t>(row));
}

void Placement::reindex(double edge) {
  edge_ = edge;
  cells_.clear();
  indexed_ = 0;
}

bool Placement::free_of_others(const scree_ball& b) {
  const Balls& balls = simulation_.engine.balls;
  const PeriodicCell& cell = simulation_.engine.cell;
  double widest = 2 * b.radius;
  for (std::size_t row = indexed_; row < balls.size(); ++row) widest = std::max(widest, 2 * balls[Column::radius][row]);
  if (widest > edge_) reindex(widest * 1.0001);
  for (; indexed_ < balls.size(); ++indexed_) index(indexed_);
  int64_t offset[3];
  double image[3];
  const auto apart = [&] {
    for (offset[0] = -1; offset[0] <= 1; ++offset[0])
      for (offset[1] = -1; offset[1] <= 1; ++offset[1])
        for (offset[2] = -1; offset[2] <= 1; ++offset[2]) {
          const auto found = cells_.find(key(image, offset));
          if (found == cells_.end()) continue;
          for (uint32_t row : found->second) {
            const double dx = balls[Column::x][row] - image[0], dy = balls[Column::y][row] - image[1],
                         dz = balls[Column::z][row] - image[2], sum = b.radius + balls[Column::radius][row];
            if (dx * dx + dy * dy + dz * dz < sum * sum) return false;
          }
        }
    return true;
  };
  int64_t shift[3];
  const auto most = [&](int axis) { return cell.periodic[axis] ? 1 : 0; };
  for (shift[0] = -most(0); shift[0] <= most(0); ++shift[0])
    for (shift[1] = -most(1); shift[1] <= most(1); ++shift[1])
      for (shift[2] = -most(2); shift[2] <= most(2); ++shift[2]) {
        for (int axis = 0; axis < 3; ++axis)
          image[axis] =
              b.position[axis] + (shift[axis] == 0 ? 0.0 : static_cast<double>(shift[axis]) * cell.length(axis));
        if (!apart()) return false;
      }
  return true;
}

void Placement::add(const scree_ball& b) {
  Engine& engine = simulation_.engine;
  Balls& balls = engine.balls;
  const std::size_t row = balls.size();
  balls.resize(row + 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto column = [&](Column first) { return static_cast<Column>(static_cast<std::size_t>(first) + axis); };
    balls[column(Column::x)][row] = b.position[axis];
    double v = set_.velocity ? (*set_.velocity)[axis] : 0;
    if ((b.given & SCREE_BALL_VELOCITY) != 0) v = b.velocity[axis];
    balls[column(Column::vx)][row] = v;
  }
  double spin[3] = {0, 0, 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (set_.spin) spin[axis] = (*set_.spin)[axis];
    if ((b.given & SCREE_BALL_SPIN) != 0) spin[axis] = b.spin[axis];
  }
  if (any(spin)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto column = static_cast<Column>(static_cast<std::size_t>(Column::wx) + axis);
      balls.require(column, "balls start with a spin");
      balls[column][row] = spin[axis];
    }
  }
  const double density = (b.given & SCREE_BALL_DENSITY) != 0 ? b.density : *set_.density;
  balls[Column::radius][row] = b.radius;
  balls[Column::mass][row] = 4.0 / 3.0 * pi * (b.radius * b.radius * b.radius) * density;
  const bool own_id = (b.given & SCREE_BALL_ID) != 0;
  const uint64_t id = own_id ? b.id : balls.next_id;
  balls.id()[row] = id;
  if (!ids_.empty()) ids_.insert(id);
  balls.next_id = std::max(balls.next_id, id + 1);
  std::string leaf = set_.name;
  if ((b.given & SCREE_BALL_GROUP) != 0 && b.group != nullptr && *b.group != '\0') leaf += std::string(".") + b.group;
  const auto known = leaves_.find(leaf);
  balls.group()[row] = known != leaves_.end() ? known->second : (leaves_[leaf] = simulation_.groups.leaf(leaf));
  if (set_.fixed) balls.require_fixed()[row] = fix_all;
  for (const PieceProperty& property : set_.contact) {
    if (property.drawn != nullptr) {
      const Random random(simulation_.scene.seed, "balls/" + set_.name + "/" + property.name);
      balls.require_property(property.name)[row] = property.drawn->draw(random, id);
    }
    if (property.formula == nullptr) continue;
    std::vector<double> values;
    for (const std::string& name : property.formula->names())
      values.push_back(name == "x" ? b.position[0] : name == "y" ? b.position[1] : b.position[2]);
    balls.require_property(property.name)[row] = property.formula->evaluate(values);
  }
  ++placed_;
}

}  // namespace scree::core
