#include "core/world/balls.hpp"

namespace scree::core {

namespace {
constexpr std::size_t column_count = static_cast<std::size_t>(Column::count);
constexpr const char* names[column_count] = {"x",       "y",       "z",           "vx",           "vy",
                                             "vz",      "radius",  "mass",        "inverse_mass", "wx",
                                             "wy",      "wz",      "reference_x", "reference_y",  "reference_z",
                                             "force_x", "force_y", "force_z",     "moment_x",     "moment_y",
                                             "moment_z"};

template <class T>
void gather_rows(Array<T>& values, const uint32_t* order, std::size_t n) {
  Array<T> fresh;
  fresh.resize_for_overwrite(n);
  for (std::size_t k = 0; k < n; ++k) fresh[k] = values[order[k]];
  values.swap(fresh);
}
}  // namespace

const char* Balls::name(Column column) { return names[static_cast<std::size_t>(column)]; }

Balls::Balls() {
  for (Column c : {Column::x, Column::y, Column::z}) require(c, "position");
  for (Column c : {Column::vx, Column::vy, Column::vz}) require(c, "velocity");
  require(Column::radius, "shape");
  require(Column::mass, "weight");
  require(Column::inverse_mass, "motion");
}

template <class F>
void Balls::each_array(F f) {
  for (std::size_t c = 0; c < column_count; ++c)
    if (present_[c]) f(values_[c]);
  for (auto& [key, values] : properties_) f(values);
  f(group_);
  if (!fixed_.empty()) f(fixed_);
  f(id_);
}

void Balls::require(Column column, const std::string& reason) {
  const auto c = static_cast<std::size_t>(column);
  if (present_[c]) return;
  present_[c] = true;
  reason_[c] = reason;
  values_[c].resize(size());
}

double* Balls::property(const std::string& name) {
  const auto found = properties_.find(name);
  return found == properties_.end() ? nullptr : found->second.data();
}

double* Balls::require_property(const std::string& name) {
  auto& values = properties_[name];
  values.resize(size());
  return values.data();
}

uint8_t* Balls::require_fixed() {
  if (fixed_.empty()) fixed_.resize(size());
  return fixed_.data();
}

void Balls::resize(std::size_t rows) {
  each_array([&](auto& values) {
    // One ball at a time is how generators add them.
    if (rows == values.size() + 1 && rows % 1024 == 1) values.reserve(rows + rows / 4 + 1023);
    values.resize(rows);
  });
}

void Balls::trim() {
  each_array([](auto& values) { values.trim(); });
}

void Balls::reorder(const uint32_t* order) {
  const std::size_t n = size();
  each_array([&](auto& values) { gather_rows(values, order, n); });
}

void Balls::keep(const std::vector<uint8_t>& keep) {
  Array<uint32_t> order;
  for (std::size_t row = 0; row < size(); ++row)
    if (keep[row]) order.push_back(static_cast<uint32_t>(row));
  each_array([&](auto& values) { gather_rows(values, order.data(), order.size()); });
}

void Balls::update_inverse_mass() {
  double* inverse = (*this)[Column::inverse_mass];
  const double* mass = (*this)[Column::mass];
  for (std::size_t row = 0; row < size(); ++row)
    inverse[row] = !fixed_.empty() && fixed_[row] == fix_all ? 0.0 : 1.0 / mass[row];
}

std::vector<Balls::Listed> Balls::list() const {
  std::vector<Listed> out;
  for (std::size_t c = 0; c < column_count; ++c)
    if (present_[c]) out.push_back({names[c], reason_[c], sizeof(double), values_[c].bytes()});
  for (const auto& [key, values] : properties_)
    out.push_back({"property " + key, "given on pieces", sizeof(double), values.bytes()});
  out.push_back({"id", "identity", sizeof(uint64_t), id_.bytes()});
  out.push_back({"group", "rules and groups", sizeof(uint16_t), group_.bytes()});
  if (!fixed_.empty()) out.push_back({"fixed", "some balls are fixed", sizeof(uint8_t), fixed_.bytes()});
  return out;
}

}  // namespace scree::core
