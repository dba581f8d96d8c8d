#pragma once
// A host for writers: frames to hand out, and the files that come back, in memory.
#include <scree/abi.h>

#include <map>
#include <string>
#include <vector>

namespace support {

class MemoryFiles {
 public:
  MemoryFiles() { table_ = {sizeof(scree_files), 0, this, &append, &replace}; }
  MemoryFiles(const MemoryFiles&) = delete;
  MemoryFiles& operator=(const MemoryFiles&) = delete;
  const scree_files* table() const { return &table_; }

  std::map<std::string, std::string> content;
  int replaced = 0;   // number of whole files written
  bool full = false;  // refuse everything, like a full disk

 private:
  static int append(void* self, const char* name, const void* bytes, uint64_t size) {
    auto& files = *static_cast<MemoryFiles*>(self);
    if (files.full) return 0;
    files.content[name].append(static_cast<const char*>(bytes), size);
    return 1;
  }
  static int replace(void* self, const char* name, const void* bytes, uint64_t size) {
    auto& files = *static_cast<MemoryFiles*>(self);
    if (files.full) return 0;
    ++files.replaced;
    files.content[name].assign(static_cast<const char*>(bytes), size);
    return 1;
  }
  scree_files table_{};
};

/// A frame with `balls` balls, `contacts` contacts with a force, and one wall of a triangle and a square. Every number
/// is a simple function of its index and of the frame, so that a reader can compute it again:
///   ball k: position (k, k/3, -k/7 + frame), radius 0.1 + k, id 2k + 1, velocity (k + 0.5, -k, frame), charge 1/(k +
///   1) contact k: position (k/2, 0, frame), id1 k + 1, id2 k + 2 but 0 for the last, force (k, 2k, -3k)
struct SampleFrame {
  SampleFrame(uint32_t index, std::size_t balls, std::size_t contacts) {
    const double f = index;
    for (std::size_t i = 0; i < balls; ++i) {
      const double k = static_cast<double>(i);
      ball_id.push_back(2 * i + 1);
      column[0].push_back(k), column[1].push_back(k / 3), column[2].push_back(-k / 7 + f), column[3].push_back(0.1 + k);
      velocity[0].push_back(k + 0.5), velocity[1].push_back(-k), velocity[2].push_back(f);
      charge.push_back(1 / (k + 1));
    }
    for (std::size_t i = 0; i < contacts; ++i) {
      const double k = static_cast<double>(i);
      place[0].push_back(k / 2), place[1].push_back(0), place[2].push_back(f);
      id1.push_back(i + 1), id2.push_back(i + 1 == contacts ? 0 : i + 2);
      force[0].push_back(k), force[1].push_back(2 * k), force[2].push_back(-3 * k);
    }
    frame.struct_size = sizeof frame;
    frame.index = index;
    frame.cycle = 100 * uint64_t{index};
    frame.time = 0.1 * f;
    frame.ball_count = balls;
    frame.ball_id = ball_id.data();
    frame.x = column[0].data(), frame.y = column[1].data(), frame.z = column[2].data(), frame.radius = column[3].data();
    velocity_parts = {velocity[0].data(), velocity[1].data(), velocity[2].data()};
    charge_part = charge.data();
    ball_arrays = {{"velocity", "m/s", 3, 0, velocity_parts.data()}, {"charge", "1", 1, 0, &charge_part}};
    frame.ball_array_count = 2;
    frame.ball_arrays = ball_arrays.data();
    if (contacts > 0) add_contacts(contacts);
    frame.wall_count = 1;
    frame.walls = &wall;
  }
  SampleFrame(const SampleFrame&) = delete;
  SampleFrame& operator=(const SampleFrame&) = delete;

  void add_contacts(std::size_t contacts) {
    frame.contact_count = contacts;
    frame.contact_x = place[0].data(), frame.contact_y = place[1].data(), frame.contact_z = place[2].data();
    frame.contact_id1 = id1.data(), frame.contact_id2 = id2.data();
    force_parts = {force[0].data(), force[1].data(), force[2].data()};
    contact_array = {"force", "N", 3, 0, force_parts.data()};
    frame.contact_array_count = 1;
    frame.contact_arrays = &contact_array;
  }
  void quantities(const std::vector<const char*>& names, const std::vector<double>& values) {
    frame.quantity_count = static_cast<uint32_t>(names.size());
    frame.quantity_names = names.data();
    frame.quantities = values.data();
  }

  scree_frame frame{};
  std::vector<uint64_t> ball_id, id1, id2;
  std::vector<double> column[4], velocity[3], charge, place[3], force[3];
  std::vector<const double*> velocity_parts, force_parts;
  const double* charge_part = nullptr;
  std::vector<scree_array> ball_arrays;
  scree_array contact_array{};
  double triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, square[12] = {0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
  scree_polygon polygons[2] = {{3, 0, triangle}, {4, 0, square}};
  scree_wall_picture wall{"top.1", 2, 0, polygons, {1, 2, 3}, {0, 0, -0.5}};
};

}  // namespace support
