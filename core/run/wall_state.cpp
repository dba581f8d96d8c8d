#include "core/run/wall_state.hpp"

#include <algorithm>
#include <cmath>

#include "core/run/packing.hpp"

namespace scree::core {

namespace {

void pack(Packer& out, const Wall& wall) {
  out.text(wall.name);
  for (const auto* v : {&wall.velocity, &wall.spin, &wall.centre, &wall.first_centre, &wall.force, &wall.moment})
    out.f64s(v->data(), 3);
  out.f64s(wall.turn.data(), 4);
  out.u64(wall.contacts);
  out.u64(wall.contact.size());
  for (const auto& [name, value] : wall.contact) {
    out.text(name);
    out.f64(value);
  }
}

void unpack(Unpacker& in, Wall& wall) {
  for (auto* v : {&wall.velocity, &wall.spin, &wall.centre, &wall.first_centre, &wall.force, &wall.moment})
    in.f64s(v->data(), 3);
  in.f64s(wall.turn.data(), 4);
  wall.contacts = in.u64();
  wall.contact.clear();
  for (uint64_t left = in.count(16); left > 0; --left) {
    const std::string name = in.text();
    wall.contact[name] = in.f64();
  }
  const auto finite = [](const auto& v) {
    return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
  };
  double square = 0;
  for (double q : wall.turn) square += q * q;
  if (!finite(wall.velocity) || !finite(wall.spin) || !finite(wall.centre) || !finite(wall.first_centre) ||
      !(std::abs(square - 1) < 1e-6))
    in.refuse("the pose or velocity of wall '" + wall.name + "' makes no sense");
}

}  // namespace

void save_walls(const std::vector<Wall>& walls, ArchiveWriter& out) {
  Packer packer;
  packer.u64(walls.size());
  for (const Wall& wall : walls) pack(packer, wall);
  out.put("walls", packer.bytes());
}

void load_walls(std::vector<Wall>& walls, const ArchiveReader& archive) {
  Unpacker in(archive, "walls");
  if (in.count() != walls.size()) in.refuse("it holds another number of walls than were set up");
  for (Wall& wall : walls) {
    if (in.text() != wall.name) in.refuse("wall '" + wall.name + "' is not where it should be");
    unpack(in, wall);
  }
  in.finish();
}

std::vector<std::size_t> load_walls_by_name(std::vector<Wall>& walls, const ArchiveReader& archive) {
  Unpacker in(archive, "walls");
  std::vector<std::size_t> index;
  for (uint64_t left = in.count(); left > 0; --left) {
    Wall saved;
    saved.name = in.text();
    unpack(in, saved);
    const auto at = std::find_if(walls.begin(), walls.end(), [&](const Wall& wall) { return wall.name == saved.name; });
    index.push_back(at == walls.end() ? no_wall : static_cast<std::size_t>(at - walls.begin()));
    if (at == walls.end()) continue;
    // The scene says how the wall is now: its speed and properties; where it has come to is the state's.
    at->centre = saved.centre;
    at->first_centre = saved.first_centre;
    at->turn = saved.turn;
  }
  in.finish();
  return index;
}

}  // namespace scree::core
