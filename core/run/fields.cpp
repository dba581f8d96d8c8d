#include "core/run/fields.hpp"

#include <cmath>
#include <numbers>

#include "core/base/nearest.hpp"
#include "core/scene/report.hpp"

namespace scree::core {

namespace {

const std::string contact_prefix = "contact.";

double column(const Simulation& s, Column c, std::size_t row) {
  const double* values = s.engine.balls[c];
  return values == nullptr ? 0.0 : values[row];
}

double speed(Instant& now, std::size_t row) {
  const auto& v = now.observation().velocity;
  return std::sqrt(v[0][row] * v[0][row] + v[1][row] * v[1][row] + v[2][row] * v[2][row]);
}

double spin(Instant& now, std::size_t row, uint32_t c) {
  const auto& values = now.observation().spin[c];
  return row < values.size() ? values[row] : 0.0;
}

double kinetic(Simulation& s, Instant& now, std::size_t row, uint32_t) {
  const double mass = column(s, Column::mass, row), radius = column(s, Column::radius, row);
  double turning = 0;
  for (uint32_t c = 0; c < 3; ++c) turning += spin(now, row, c) * spin(now, row, c);
  return 0.5 * mass * (speed(now, row) * speed(now, row) + 0.4 * radius * radius * turning);
}

const BallField ball_fields[] = {
    {"id", "1", 1,
     [](Simulation& s, Instant&, std::size_t row, uint32_t) { return static_cast<double>(s.engine.balls.id()[row]); }},
    {"radius", "m", 1,
     [](Simulation& s, Instant&, std::size_t row, uint32_t) { return column(s, Column::radius, row); }},
    {"velocity", "m/s", 3,
     [](Simulation&, Instant& now, std::size_t row, uint32_t c) { return now.observation().velocity[c][row]; }},
    {"spin", "rad/s", 3, [](Simulation&, Instant& now, std::size_t row, uint32_t c) { return spin(now, row, c); }},
    {"force", "N", 3,
     [](Simulation&, Instant& now, std::size_t row, uint32_t c) { return now.observation().force[c][row]; }},
    {"speed", "m/s", 1, [](Simulation&, Instant& now, std::size_t row, uint32_t) { return speed(now, row); }},
    {"mass", "kg", 1, [](Simulation& s, Instant&, std::size_t row, uint32_t) { return column(s, Column::mass, row); }},
    {"density", "kg/m3", 1,
     [](Simulation& s, Instant&, std::size_t row, uint32_t) {
       const double radius = column(s, Column::radius, row);
       return column(s, Column::mass, row) / (4 * std::numbers::pi / 3 * radius * radius * radius);
     }},
    {"kinetic", "J", 1, kinetic},
    {"contacts", "1", 1,
     [](Simulation&, Instant& now, std::size_t row, uint32_t) {
       return static_cast<double>(now.contacts_of_balls()[row]);
     }},
    {"group", "1", 1,
     [](Simulation& s, Instant&, std::size_t row, uint32_t) {
       return static_cast<double>(s.engine.balls.group()[row]);
     }},
    {"fixed", "1", 1,
     [](Simulation& s, Instant&, std::size_t row, uint32_t) {
       const uint8_t* fixed = s.engine.balls.fixed();
       return fixed != nullptr && fixed[row] != 0 ? 1.0 : 0.0;
     }},
};

const ContactField contact_fields[] = {
    {"force", "N", 3, [](const ActiveContact& a, uint32_t c) { return a.force[c]; }},
    {"moment", "N m", 3, [](const ActiveContact& a, uint32_t c) { return a.moment[c]; }},
    {"normal", "1", 3, [](const ActiveContact& a, uint32_t c) { return a.normal[c]; }},
    {"normal_force", "N", 1, [](const ActiveContact& a, uint32_t) { return a.normal_force(); }},
    {"shear_force", "N", 1, [](const ActiveContact& a, uint32_t) { return a.shear_force(); }},
    {"overlap", "m", 1, [](const ActiveContact& a, uint32_t) { return a.overlap; }},
    {"sliding", "1", 1, [](const ActiveContact& a, uint32_t) { return a.sliding ? 1.0 : 0.0; }},
    {"bonded", "1", 1, [](const ActiveContact& a, uint32_t) { return a.bonded ? 1.0 : 0.0; }},
};

bool take(const std::string& name, FieldChoice& choice) {
  for (const BallField& field : ball_fields)
    if (name == field.name) {
      choice.balls.push_back(&field);
      return true;
    }
  if (!name.starts_with(contact_prefix)) return false;
  for (const ContactField& field : contact_fields)
    if (name.substr(contact_prefix.size()) == field.name) {
      choice.contacts.push_back(&field);
      return true;
    }
  return false;
}

}  // namespace

std::vector<std::string> field_names() {
  std::vector<std::string> names;
  for (const BallField& field : ball_fields) names.emplace_back(field.name);
  for (const ContactField& field : contact_fields) names.push_back(contact_prefix + field.name);
  return names;
}

FieldChoice chosen_fields(const std::vector<Name>& names, const std::string& record) {
  FieldChoice choice;
  Report report;
  const std::vector<std::string> all = field_names();
  std::string list;
  for (const std::string& name : all) list += (list.empty() ? "" : ", ") + name;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string& name = names[k].text;
    for (std::size_t before = 0; before < k; ++before)
      if (names[before].text == name)
        report.error(names[k].place, "record '" + record + "': the field '" + name + "' is named twice");
    if (take(name, choice)) continue;
    // A contact's field without its prefix is the likely slip.
    const std::string near = take(contact_prefix + name, choice) ? contact_prefix + name : nearest_name(name, all);
    report.error(names[k].place, "record '" + record + "': unknown field '" + name + "'" +
                                     (near.empty() ? "" : "; did you mean '" + near + "'?") + "  (" + list + ")");
  }
  report.raise();
  return choice;
}

}  // namespace scree::core
