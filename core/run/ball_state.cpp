#include "core/run/ball_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/run/section_check.hpp"

namespace scree::core {

namespace {

constexpr std::size_t column_count = static_cast<std::size_t>(Column::count);

std::string section_of(Column column) { return std::string("balls/") + Balls::name(column); }

std::vector<std::string> reasons_of(const Balls& balls) {
  std::vector<std::string> reasons;
  const auto listed = balls.list();
  for (std::size_t c = 0, k = 0; c < column_count; ++c)
    if (balls.has(static_cast<Column>(c))) reasons.push_back(listed[k++].reason);
  return reasons;
}

// Code that asks for one component of a vector relies on all three.
void check_triples(const Balls& balls, const ArchiveReader& in) {
  for (Column first : {Column::wx, Column::reference_x, Column::force_x, Column::moment_x}) {
    const auto c = static_cast<std::size_t>(first);
    want(balls.has(first) == balls.has(static_cast<Column>(c + 1)) &&
             balls.has(first) == balls.has(static_cast<Column>(c + 2)),
         in, "balls/columns", "a vector lacks a component");
  }
}

void check_values(const Balls& balls, const ArchiveReader& in) {
  for (std::size_t c = 0; c < column_count; ++c) {
    const auto column = static_cast<Column>(c);
    if (!balls.has(column)) continue;
    const double* values = balls[column];
    want(std::all_of(values, values + balls.size(), [](double v) { return std::isfinite(v); }), in, section_of(column),
         "a value is not a finite number");
    if (column == Column::radius || column == Column::mass)
      want(std::all_of(values, values + balls.size(), [](double v) { return v > 0; }), in, section_of(column),
           "a value is not above 0");
  }
}

void load_ids(Balls& balls, const ArchiveReader& in) {
  std::vector<uint64_t> ids = in.get<uint64_t>("balls/id");
  want(ids.size() < std::numeric_limits<uint32_t>::max(), in, "balls/id", "there are too many balls");
  balls.resize(0);
  balls.resize(ids.size());
  std::copy(ids.begin(), ids.end(), balls.id());
  balls.next_id = in.get_value<uint64_t>("balls/next_id");
  std::sort(ids.begin(), ids.end());
  want(std::adjacent_find(ids.begin(), ids.end()) == ids.end(), in, "balls/id", "two balls have one id");
  want(ids.empty() || (ids.front() > 0 && ids.back() < balls.next_id), in, "balls/id", "an id is out of range");
}

template <class T>
void copy_rows(const ArchiveReader& in, const std::string& section, T* to, std::size_t rows) {
  const std::vector<T> values = in.get<T>(section, rows);
  std::copy(values.begin(), values.end(), to);
}

}  // namespace

void save_balls(const Balls& balls, ArchiveWriter& out) {
  const std::size_t n = balls.size();
  std::vector<std::string> columns, properties;
  for (std::size_t c = 0; c < column_count; ++c)
    if (balls.has(static_cast<Column>(c))) columns.emplace_back(Balls::name(static_cast<Column>(c)));
  for (const auto& [name, values] : balls.properties()) properties.push_back(name);
  out.put("balls/id", std::span(balls.id(), n));
  out.put_value<uint64_t>("balls/next_id", balls.next_id);
  out.put("balls/group", std::span(balls.group(), n));
  if (balls.fixed() != nullptr) out.put("balls/fixed", std::span(balls.fixed(), n));
  out.put_texts("balls/columns", columns);
  out.put_texts("balls/reasons", reasons_of(balls));
  for (std::size_t c = 0; c < column_count; ++c) {
    const auto column = static_cast<Column>(c);
    if (balls.has(column)) out.put(section_of(column), std::span(balls[column], n));
  }
  out.put_texts("balls/properties", properties);
  for (const auto& [name, values] : balls.properties())
    out.put("balls/property/" + name, std::span(values.data(), values.size()));
}

void load_balls(Balls& balls, const ArchiveReader& in, std::size_t groups) {
  load_ids(balls, in);
  const std::size_t n = balls.size();
  copy_rows(in, "balls/group", balls.group(), n);
  want(std::all_of(balls.group(), balls.group() + n, [&](uint16_t g) { return g < groups; }), in, "balls/group",
       "a ball is in a group that does not exist");
  if (in.has("balls/fixed")) {
    copy_rows(in, "balls/fixed", balls.require_fixed(), n);
    want(std::all_of(balls.fixed(), balls.fixed() + n, [](uint8_t bits) { return bits <= fix_all; }), in, "balls/fixed",
         "a ball is fixed in a direction that does not exist");
  }
  const std::vector<std::string> columns = in.get_texts("balls/columns"), reasons = in.get_texts("balls/reasons");
  want(columns.size() == reasons.size(), in, "balls/reasons", "its size differs from that of 'balls/columns'");
  const Balls plain;
  std::size_t known = 0;
  for (std::size_t c = 0; c < column_count; ++c) {
    const auto column = static_cast<Column>(c);
    const auto at = std::find(columns.begin(), columns.end(), Balls::name(column));
    if (at == columns.end()) {
      want(!plain.has(column), in, "balls/columns", "a column that every ball has is missing");
      continue;
    }
    ++known;
    balls.require(column, reasons[static_cast<std::size_t>(at - columns.begin())]);
    copy_rows(in, section_of(column), balls[column], n);
  }
  want(known == columns.size(), in, "balls/columns", "it names a column that this version does not know");
  for (const std::string& name : in.get_texts("balls/properties"))
    copy_rows(in, "balls/property/" + name, balls.require_property(name), n);
  check_triples(balls, in);
  check_values(balls, in);
}

}  // namespace scree::core
