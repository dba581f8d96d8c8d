#pragma once
#include <string>
#include <vector>

#include "core/run/instant.hpp"
#include "core/run/simulation.hpp"

namespace scree::core {

/// A field of a frame: one array per component, filled for the balls in id order or for the active contacts in pair
/// order. A scene names a contact's field with `contact.` before it.
struct BallField {
  const char *name, *unit;
  uint32_t components;
  double (*read)(Simulation&, Instant&, std::size_t row, uint32_t component);
};
struct ContactField {
  const char *name, *unit;
  uint32_t components;
  double (*read)(const ActiveContact&, uint32_t component);
};

/// What a recorder shows.
struct FieldChoice {
  std::vector<const BallField*> balls;
  std::vector<const ContactField*> contacts;
};

/// All names that `fields` may hold.
std::vector<std::string> field_names();
/// Finds each name; throws SceneErrors with place and nearest name.
FieldChoice chosen_fields(const std::vector<Name>& names, const std::string& record);

}  // namespace scree::core
