#pragma once
#include <set>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace scree::core {

/// Collects every error of a scene, so that a user mends them in one round. [one thread]
class Report {
 public:
  void error(const Place& place, const std::string& message);
  /// A plug-in that cannot be opened: exit 4 instead of 3 when nothing else is wrong.
  void missing_plugin(const Place& place, const std::string& message);
  void warn(const Place& place, const std::string& message);
  bool clean() const { return errors_.empty(); }
  std::vector<std::string> warnings() const { return warnings_; }
  /// Throws SceneErrors or Refusal(Exit::plugin) when there was any error. Errors are listed in the order of the files.
  void raise() const;

 private:
  struct Entry {
    Place place;
    std::string text;
    bool plugin;
    size_t file_order;
  };
  void add(const Place& place, const std::string& message, bool plugin);
  std::vector<Entry> errors_;
  std::vector<std::string> warnings_, files_;
  std::set<std::string> seen_;
};

}  // namespace scree::core
