#include <scree/writer.hpp>

#include <array>
#include <charconv>
#include <string>
#include <vector>

#include "polydata.hpp"

namespace {

using namespace scree;

/// Six digits at least, so that names sort.
std::string numbered(uint32_t index) {
  const std::string digits = std::to_string(index);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

/// A name that is safe in a file name: other bytes become %XX.
std::string file_name(std::string_view name) {
  constexpr const char* hex = "0123456789ABCDEF";
  std::string safe;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (byte >= '0' && byte <= '9') || (byte >= 'a' && byte <= 'z') || (byte >= 'A' && byte <= 'Z') ||
                       byte == '_' || byte == '-';
    if (plain) {
      safe += c;
    } else {
      safe.append({'%', hex[byte / 16], hex[byte % 16]});
    }
  }
  return safe;
}

void add_arrays(vtk::PolyData& data, uint32_t count, const scree_array* arrays) {
  for (uint32_t k = 0; k < count; ++k) data.point_array(arrays[k].name, {arrays[k].component, arrays[k].components});
}

/// Pictures for ParaView: one .vtp file per frame for balls, contacts and each wall, and a .pvd that lists them.
struct Vtk {
  static constexpr uint32_t wants = SCREE_WANTS_BALLS | SCREE_WANTS_CONTACTS | SCREE_WANTS_WALLS;
  std::string name;
  std::string entries;  // the lines of the .pvd so far
  uint64_t frames = 0, listed = 0;

  static void describe(Settings<Vtk>&) {}
  void open(const std::string& recorder, const Files&) { name = file_name(recorder); }

  void frame(const scree_frame& frame, const Files& files) {
    const std::string number = name + "_" + numbered(frame.index) + ".vtp";
    entry(frame.time, 0, "balls", "balls/" + number);
    files.replace("balls/" + number, balls(frame));
    if (frame.contact_count > 0 || frame.contact_array_count > 0) {
      entry(frame.time, 1, "contacts", "contacts/" + number);
      files.replace("contacts/" + number, contacts(frame));
    }
    for (uint32_t k = 0; k < frame.wall_count; ++k) {
      const scree_wall_picture& wall = frame.walls[k];
      const std::string file = "walls/" + name + "_" + file_name(wall.name) + "_" + numbered(frame.index) + ".vtp";
      entry(frame.time, 2 + k, wall.name, file);
      files.replace(file, picture(frame.time, wall));
    }
    ++frames;
    // A long list is rewritten each time it has grown by a sixteenth, so all rewriting together stays linear.
    if (frames <= 256 || frames - listed >= listed / 16) list(files);
  }
  void close(const Files& files) {
    if (frames > 0) list(files);
  }

  std::string save() const { return std::to_string(frames) + '\n' + entries; }
  void load(std::string_view bytes) {
    const std::size_t line = bytes.find('\n');
    const auto [end, error] = std::from_chars(bytes.data(), bytes.data() + bytes.size(), frames);
    if (line == std::string_view::npos || error != std::errc() || end != bytes.data() + line)
      throw std::runtime_error("the saved list of frames is damaged");
    entries = bytes.substr(line + 1);
    listed = 0;
  }

 private:
  void entry(double time, uint32_t part, std::string_view group, const std::string& file) {
    entries += "    <DataSet timestep=\"" + shortest(time) + "\" group=\"\" part=\"" + std::to_string(part) +
               "\" name=\"" + vtk::escaped(group) + "\" file=\"" + vtk::escaped(file) + "\"/>\n";
  }
  void list(const Files& files) {
    files.replace(name + ".pvd",
                  "<?xml version=\"1.0\"?>\n"
                  "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
                  "  <Collection>\n" +
                      entries + "  </Collection>\n</VTKFile>\n");
    listed = frames;
  }

  static std::string balls(const scree_frame& frame) {
    vtk::PolyData data(frame.time);
    data.points(frame.ball_count, frame.x, frame.y, frame.z);
    data.vertices();
    data.point_ids("id", frame.ball_id);
    data.point_array("radius", {{frame.radius}});
    for (uint32_t k = 0; k < frame.ball_array_count; ++k)
      if (std::string_view(frame.ball_arrays[k].name) != "radius") add_arrays(data, 1, frame.ball_arrays + k);
    return data.text();
  }
  static std::string contacts(const scree_frame& frame) {
    vtk::PolyData data(frame.time);
    data.points(frame.contact_count, frame.contact_x, frame.contact_y, frame.contact_z);
    data.vertices();
    data.point_ids("id1", frame.contact_id1);
    data.point_ids("id2", frame.contact_id2);
    add_arrays(data, frame.contact_array_count, frame.contact_arrays);
    return data.text();
  }
  static std::string picture(double time, const scree_wall_picture& wall) {
    vtk::PolyData data(time);
    std::vector<std::vector<double>> faces;
    for (uint32_t k = 0; k < wall.polygon_count; ++k)
      faces.emplace_back(wall.polygons[k].xyz, wall.polygons[k].xyz + 3 * std::size_t{wall.polygons[k].corners});
    data.polygons(faces);
    data.face_array("force", wall.force);
    data.face_array("velocity", wall.velocity);
    return data.text();
  }
};

}  // namespace

SCREE_PLUGIN(scree::writer<Vtk>("vtk", "1.0.0", "frames for ParaView"))
