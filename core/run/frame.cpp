#include "core/run/frame.hpp"

#include <algorithm>

namespace scree::core {

namespace {

using V = std::array<double, 3>;

struct Box {
  V low{}, high{};
};

/// The same box, or one around it, in the wall's frame.
Box in_frame(const Wall& wall, const ShownBox& box) {
  Box out;
  for (unsigned corner = 0; corner < 8; ++corner) {
    V point{};
    for (std::size_t c = 0; c < 3; ++c) point[c] = (corner >> c & 1u) != 0 ? box.high()[c] : box.low()[c];
    point = wall.to_frame(point);
    for (std::size_t c = 0; c < 3; ++c) {
      out.low[c] = corner == 0 ? point[c] : std::min(out.low[c], point[c]);
      out.high[c] = corner == 0 ? point[c] : std::max(out.high[c], point[c]);
    }
  }
  return out;
}

V to_scene(const Wall& wall, const double* corner) {
  const V turned = wall.from_frame(
      {corner[0] - wall.first_centre[0], corner[1] - wall.first_centre[1], corner[2] - wall.first_centre[2]});
  return {turned[0] + wall.centre[0], turned[1] + wall.centre[1], turned[2] + wall.centre[2]};
}

std::vector<std::vector<double>> outline(const Wall& wall, const ShownBox& box) {
  struct Sink {
    const Wall* wall;
    std::vector<std::vector<double>> polygons;
  } sink{&wall, {}};
  if (wall.table->outline == nullptr) return {};
  const Box local = in_frame(wall, box);
  wall.table->outline(wall.geometry.get(), local.low.data(), local.high.data(), &sink,
                      [](void* self, uint32_t corners, const double* xyz) {
                        Sink& to = *static_cast<Sink*>(self);
                        std::vector<double>& polygon = to.polygons.emplace_back();
                        for (std::size_t k = 0; k < corners; ++k)
                          for (const double value : to_scene(*to.wall, xyz + 3 * k)) polygon.push_back(value);
                      });
  return sink.polygons;
}

}  // namespace

template <class Read>
scree_array Frame::array(const char* name, const char* unit, uint32_t components, std::size_t count, Read read) {
  std::vector<const double*>& pointers = components_.emplace_back();
  for (uint32_t c = 0; c < components; ++c) {
    Values& values = values_.emplace_back(count);
    for (std::size_t k = 0; k < count; ++k) values[k] = read(k, c);
    pointers.push_back(values.data());
  }
  return {name, unit, components, 0, pointers.data()};
}

Frame::Frame(Simulation& simulation, Quantities& quantities, const FrameContent& content, uint32_t index,
             const ShownBox& box) {
  frame_.struct_size = sizeof frame_;
  frame_.index = index;
  frame_.cycle = simulation.engine.clock.cycle;
  frame_.time = simulation.engine.clock.time();
  if ((content.wants & SCREE_WANTS_BALLS) != 0) add_balls(simulation, quantities.instant(), content.fields);
  if ((content.wants & SCREE_WANTS_CONTACTS) != 0 && !content.fields.contacts.empty())
    add_contacts(quantities.instant(), content.fields);
  if ((content.wants & SCREE_WANTS_WALLS) != 0) add_walls(simulation.engine, box);
  if ((content.wants & SCREE_WANTS_QUANTITIES) != 0) add_quantities(quantities, content);
}

void Frame::add_balls(Simulation& simulation, Instant& now, const FieldChoice& fields) {
  const Balls& balls = simulation.engine.balls;
  const std::vector<uint32_t>& order = now.order();
  const std::size_t n = order.size();
  for (const uint32_t row : order) ball_ids_.push_back(balls.id()[row]);
  frame_.ball_count = n;
  frame_.ball_id = ball_ids_.data();
  const auto column = [&](Column c) {
    return array("", "m", 1, n, [&](std::size_t k, uint32_t) { return balls[c][order[k]]; }).component[0];
  };
  frame_.x = column(Column::x);
  frame_.y = column(Column::y);
  frame_.z = column(Column::z);
  frame_.radius = column(Column::radius);
  for (const BallField* field : fields.balls) {
    // Every frame holds the ids as they are; as doubles they would only be a second, less exact column.
    if (std::string_view(field->name) == "id") continue;
    ball_arrays_.push_back(array(field->name, field->unit, field->components, n,
                                 [&](std::size_t k, uint32_t c) { return field->read(simulation, now, order[k], c); }));
  }
  frame_.ball_array_count = static_cast<uint32_t>(ball_arrays_.size());
  frame_.ball_arrays = ball_arrays_.data();
}

void Frame::add_contacts(Instant& now, const FieldChoice& fields) {
  const std::vector<ActiveContact>& all = now.contacts();
  for (const ActiveContact& contact : all) {
    contact_ids_[0].push_back(contact.id1);
    contact_ids_[1].push_back(contact.id2);
  }
  frame_.contact_count = all.size();
  frame_.contact_id1 = contact_ids_[0].data();
  frame_.contact_id2 = contact_ids_[1].data();
  const scree_array point = array("", "m", 3, all.size(), [&](std::size_t k, uint32_t c) { return all[k].point[c]; });
  frame_.contact_x = point.component[0];
  frame_.contact_y = point.component[1];
  frame_.contact_z = point.component[2];
  for (const ContactField* field : fields.contacts)
    contact_arrays_.push_back(array(field->name, field->unit, field->components, all.size(),
                                    [&](std::size_t k, uint32_t c) { return field->read(all[k], c); }));
  frame_.contact_array_count = static_cast<uint32_t>(contact_arrays_.size());
  frame_.contact_arrays = contact_arrays_.data();
}

void Frame::add_walls(const Engine& engine, const ShownBox& box) {
  for (const Wall& wall : engine.walls) {
    Picture& picture = pictures_.emplace_back();
    picture.corners = outline(wall, box);
    for (const Values& corners : picture.corners)
      picture.polygons.push_back({static_cast<uint32_t>(corners.size() / 3), 0, corners.data()});
    scree_wall_picture one{};
    one.name = wall.name.c_str();
    one.polygon_count = static_cast<uint32_t>(picture.polygons.size());
    one.polygons = picture.polygons.data();
    for (std::size_t c = 0; c < 3; ++c) {
      one.force[c] = wall.force[c];
      one.velocity[c] = wall.velocity[c];
    }
    walls_.push_back(one);
  }
  frame_.wall_count = static_cast<uint32_t>(walls_.size());
  frame_.walls = walls_.data();
}

void Frame::add_quantities(Quantities& quantities, const FrameContent& content) {
  for (const auto& formula : content.quantities) {
    names_.push_back(formula->text().c_str());
    units_.push_back(quantities.unit(*formula));
    quantities_.push_back(quantities.value(*formula));
  }
  for (const std::string& unit : units_) unit_texts_.push_back(unit.c_str());
  frame_.quantity_count = static_cast<uint32_t>(names_.size());
  frame_.quantity_names = names_.data();
  frame_.quantity_units = unit_texts_.data();
  frame_.quantities = quantities_.data();
}

}  // namespace scree::core
