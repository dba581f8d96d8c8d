#pragma once
// One VTK XML PolyData file (.vtp) in memory: header in XML, arrays as raw bytes appended, little-endian, 64-bit sizes.
// Format: "VTK File Formats", https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vtk {

/// Text for an XML attribute.
std::string escaped(std::string_view text);

class PolyData {
 public:
  explicit PolyData(double time);

  /// The points, component by component. All arrays of `point_array` have as many tuples.
  void points(std::size_t count, const double* x, const double* y, const double* z);
  /// Draws every point: one cell of vertices that names them all.
  void vertices();
  /// Polygons by their corners; also sets the points.
  void polygons(std::span<const std::vector<double>> faces);

  /// Component-major input, tuple-major in the file.
  void point_array(std::string_view name, std::span<const double* const> component);
  void point_ids(std::string_view name, const uint64_t* ids);
  /// The same tuple for every polygon.
  void face_array(std::string_view name, std::span<const double> tuple);

  std::string text() const;

 private:
  std::string array(std::string_view type, std::string_view name, std::size_t components, std::string_view attributes,
                    const void* bytes, std::size_t size);
  std::string numbers(std::string_view name, std::size_t components, const std::vector<double>& values);
  std::string integers(std::string_view name, const std::vector<int64_t>& values);

  std::size_t point_count_ = 0, vertex_count_ = 0, face_count_ = 0;
  std::string field_, points_, vertices_, faces_, point_data_, face_data_;
  std::string appended_;
};

}  // namespace vtk
