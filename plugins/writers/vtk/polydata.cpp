#include "polydata.hpp"

#include <bit>

namespace vtk {

static_assert(std::endian::native == std::endian::little, "the file is declared as little-endian");

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else {
      out += c;
    }
  }
  return out;
}

PolyData::PolyData(double time) {
  field_ = array("Float64", "TimeValue", 1, " NumberOfTuples=\"1\"", &time, sizeof time);
}

std::string PolyData::array(std::string_view type, std::string_view name, std::size_t components,
                            std::string_view attributes, const void* bytes, std::size_t size) {
  std::string xml = "        <DataArray type=\"" + std::string(type) + "\" Name=\"" + escaped(name) +
                    "\" NumberOfComponents=\"" + std::to_string(components) + "\"" + std::string(attributes) +
                    " format=\"appended\" offset=\"" + std::to_string(appended_.size()) + "\"/>\n";
  const uint64_t length = size;
  appended_.append(reinterpret_cast<const char*>(&length), sizeof length);
  appended_.append(static_cast<const char*>(bytes), size);
  return xml;
}

std::string PolyData::numbers(std::string_view name, std::size_t components, const std::vector<double>& values) {
  return array("Float64", name, components, "", values.data(), values.size() * sizeof(double));
}

std::string PolyData::integers(std::string_view name, const std::vector<int64_t>& values) {
  return array("Int64", name, 1, "", values.data(), values.size() * sizeof(int64_t));
}

void PolyData::points(std::size_t count, const double* x, const double* y, const double* z) {
  point_count_ = count;
  std::vector<double> xyz;
  xyz.reserve(3 * count);
  for (std::size_t k = 0; k < count; ++k) xyz.insert(xyz.end(), {x[k], y[k], z[k]});
  points_ = numbers("points", 3, xyz);
}

void PolyData::vertices() {
  std::vector<int64_t> all(point_count_), end;
  for (std::size_t k = 0; k < point_count_; ++k) all[k] = static_cast<int64_t>(k);
  if (point_count_ > 0) end.push_back(static_cast<int64_t>(point_count_));
  vertex_count_ = end.size();
  vertices_ = integers("connectivity", all) + integers("offsets", end);
}

void PolyData::polygons(std::span<const std::vector<double>> faces) {
  std::vector<double> xyz;
  std::vector<int64_t> corner, end;
  for (const std::vector<double>& face : faces) {
    xyz.insert(xyz.end(), face.begin(), face.end());
    while (corner.size() < xyz.size() / 3) corner.push_back(static_cast<int64_t>(corner.size()));
    end.push_back(static_cast<int64_t>(corner.size()));
  }
  point_count_ = corner.size();
  face_count_ = end.size();
  points_ = numbers("points", 3, xyz);
  faces_ = integers("connectivity", corner) + integers("offsets", end);
}

void PolyData::point_array(std::string_view name, std::span<const double* const> component) {
  std::vector<double> values;
  values.reserve(point_count_ * component.size());
  for (std::size_t k = 0; k < point_count_; ++k)
    for (const double* values_of : component) values.push_back(values_of[k]);
  point_data_ += numbers(name, component.size(), values);
}

void PolyData::point_ids(std::string_view name, const uint64_t* ids) {
  point_data_ += integers(name, std::vector<int64_t>(ids, ids + point_count_));
}

void PolyData::face_array(std::string_view name, std::span<const double> tuple) {
  std::vector<double> values;
  for (std::size_t k = 0; k < face_count_; ++k) values.insert(values.end(), tuple.begin(), tuple.end());
  face_data_ += numbers(name, tuple.size(), values);
}

std::string PolyData::text() const {
  const auto section = [](const std::string& name, const std::string& arrays) {
    return "      <" + name + ">\n" + arrays + "      </" + name + ">\n";
  };
  return "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
         "  <PolyData>\n" +
         section("FieldData", field_) + "    <Piece NumberOfPoints=\"" + std::to_string(point_count_) +
         "\" NumberOfVerts=\"" + std::to_string(vertex_count_) +
         "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" + std::to_string(face_count_) + "\">\n" +
         section("Points", points_) + (vertices_.empty() ? "" : section("Verts", vertices_)) +
         (faces_.empty() ? "" : section("Polys", faces_)) + section("PointData", point_data_) +
         section("CellData", face_data_) +
         "    </Piece>\n"
         "  </PolyData>\n"
         "  <AppendedData encoding=\"raw\">\n_" +
         appended_ + "\n  </AppendedData>\n</VTKFile>\n";
}

}  // namespace vtk
