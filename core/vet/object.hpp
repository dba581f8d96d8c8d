#pragma once
#include <scree/abi.h>

#include <string>
#include <vector>

#include "core/vet/check.hpp"
#include "core/vet/numbers.hpp"

namespace scree::core::vet {

/// One setting as a scene would give it.
struct Given {
  uint32_t property = 0, type = 0, rows = 0, columns = 0;
  std::vector<double> numbers;
  std::vector<std::string> texts;
};
using Settings = std::vector<Given>;
std::string text_of(const scree_object& table, const Settings& settings);

/// A wall, generator, process or writer, alive as long as this.
class Object {
 public:
  explicit Object(const scree_object& table);
  ~Object();
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;

  /// Sets one value; the reason when it is refused, "" when it is not.
  std::string set(const Given& given);
  std::string check();
  /// All settings, then the check. Throws Failed when one that was accepted before is refused now.
  void set_all(const Settings& settings);
  void* get() const { return self_; }

 private:
  const scree_object& table_;
  void* self_;
};

const scree_object& object_of(const Component& component);

/// Random settings that the component accepts: values within their bounds, all that are required, others by chance.
/// Throws Skipped when nothing that was tried is accepted, with the last refusal.
std::vector<Settings> accepted_settings(const Subject& subject, std::size_t count, uint64_t seed = 1);

/// A buffer for a refusal.
struct Refused {
  char why[512] = "";
  scree_refusal table{sizeof(scree_refusal), sizeof why, why};
};

// Checks of every kind but contact models.
Outcome settings_accepted(const Subject& subject);
Outcome settings_refused(const Subject& subject);
Outcome objects_given_back(const Subject& subject);

}  // namespace scree::core::vet
