#include <scree/generator.hpp>

#include <charconv>
#include <stdexcept>
#include <unordered_map>

#include "table.hpp"

namespace {

using namespace scree;

enum Column { x, y, z, radius, id, group, density, vx, vy, vz, wx, wy, wz, column_count };
constexpr std::array<std::string_view, column_count> column_names{"x",  "y",  "z",  "radius", "id", "group", "density",
                                                                  "vx", "vy", "vz", "wx",     "wy", "wz"};
constexpr const char* all_columns = "x y z radius (or r) id group (or type) density vx vy vz wx wy wz";

/// Where each column stands in the file; -1: it is not there.
using Places = std::array<int, column_count>;

Column column_of(std::string_view name) {
  if (name == "r") return radius;
  if (name == "type") return group;
  for (std::size_t k = 0; k < column_names.size(); ++k)
    if (column_names[k] == name) return static_cast<Column>(k);
  return column_count;
}

Places places_of(const csv::Table& table) {
  Places places;
  places.fill(-1);
  const csv::Row& header = table.header();
  for (std::size_t k = 0; k < header.cells.size(); ++k) {
    const std::string name(header.cells[k]);
    const Column column = column_of(name);
    if (column == column_count)
      table.refuse(header.line, "unknown column '" + name + "'; known are: " + std::string(all_columns));
    if (places[column] >= 0)
      table.refuse(header.line, "column '" + name + "' says '" + std::string(column_names[column]) + "' a second time");
    places[column] = static_cast<int>(k);
  }
  for (const Column column : {x, y, z, radius})
    if (places[column] < 0) table.refuse(header.line, "column '" + std::string(column_names[column]) + "' is missing");
  for (const Column first : {vx, wx})
    for (std::size_t k = 1; k < 3; ++k)
      if ((places[first] < 0) != (places[first + k] < 0))
        table.refuse(header.line, "columns '" + std::string(column_names[first]) + "' to '" +
                                      std::string(column_names[first + 2]) + "' must be given together");
  return places;
}

/// The cells of one row, by column.
class Reader {
 public:
  Reader(const csv::Table& table, const Places& places) : table_(table), places_(places) {}
  void at(const csv::Row& row) { row_ = &row; }
  bool has(Column column) const { return places_[column] >= 0; }
  std::string_view text(Column column) const { return row_->cells[static_cast<std::size_t>(places_[column])]; }

  double number(Column column) const {
    std::string_view cell = text(column);
    if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
      refuse(column, "is not a finite number");
    return value;
  }
  double positive(Column column) const {
    const double value = number(column);
    if (!(value > 0)) refuse(column, "must be above 0");
    return value;
  }
  Vec3 vector(Column first) const {
    return {number(first), number(static_cast<Column>(first + 1)), number(static_cast<Column>(first + 2))};
  }
  uint64_t whole(Column column) const {
    const std::string_view cell = text(column);
    uint64_t value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size() || value == 0)
      refuse(column, "must be an integer of at least 1");
    return value;
  }
  std::string name(Column column) const {
    const std::string_view cell = text(column);
    for (const char c : cell)
      if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-'))
        refuse(column, "may hold letters, digits, '_' and '-' only");
    return std::string(cell);
  }
  [[noreturn]] void refuse(Column column, const std::string& why) const {
    table_.refuse(row_->line, std::string(column_names[column]) + " '" + std::string(text(column)) + "' " + why);
  }

 private:
  const csv::Table& table_;
  const Places& places_;
  const csv::Row* row_ = nullptr;
};

/// Balls from a CSV file with a header.
struct File {
  std::string path;

  static void describe(Settings<File>& settings) {
    settings.file("path", &File::path, "CSV file with a header that names its columns").required();
  }

  void generate(Sink& sink) const {
    const std::string text = csv::read_file(path);
    const csv::Table table(text, path);
    const Places places = places_of(table);
    Reader reader(table, places);
    std::vector<Ball> balls;  // nothing is placed before the whole file has been read
    std::unordered_map<uint64_t, std::size_t> line_of;
    for (const csv::Row& row : table.rows()) {
      reader.at(row);
      Ball ball{.position = reader.vector(x), .radius = reader.positive(radius)};
      if (reader.has(density)) ball.density = reader.positive(density);
      if (reader.has(vx)) ball.velocity = reader.vector(vx);
      if (reader.has(wx)) ball.spin = reader.vector(wx);
      if (reader.has(group)) ball.group = reader.name(group);
      if (reader.has(id)) {
        ball.id = reader.whole(id);
        const auto [earlier, fresh] = line_of.emplace(*ball.id, row.line);
        if (!fresh) reader.refuse(id, "is already the id of line " + std::to_string(earlier->second));
      }
      balls.push_back(std::move(ball));
    }
    for (const Ball& ball : balls) sink.ball(ball);
  }
};

}  // namespace

SCREE_PLUGIN(scree::generator<File>("file", "1.0.0", "balls from a CSV file"))
