#pragma once
// A plug-in library of this build, driven through its C tables and nothing else: these tests say what the library does,
// whatever the program around it does with it.
#include <dlfcn.h>
#include <scree/abi.h>

#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "support/paths.hpp"

namespace support {

using Vector = std::array<double, 3>;

/// The table of component `name` in <kind>/<name>.so. The library stays open.
template <class Table>
const Table& opened(const std::string& kind, const std::string& name) {
  const std::string file = support::plugin_dir() + "/" + kind + "/" + name + ".so";
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw std::runtime_error(dlerror());
  const auto* header = static_cast<const scree_plugin_header*>(dlsym(library, "scree_plugin"));
  if (header == nullptr || header->magic != SCREE_MAGIC) throw std::runtime_error(file + " has no plug-in header");
  for (uint32_t k = 0; k < header->component_count; ++k)
    if (name == header->components[k].name) return *static_cast<const Table*>(header->components[k].table());
  throw std::runtime_error(file + " has no component " + name);
}

/// Collects the text of a refusal.
struct Refused {
  char text[1024] = "";
  scree_refusal table{sizeof(scree_refusal), sizeof text, text};
};

/// An object of a component. `set` and `check` return the refusal, "" when there was none.
class Object {
 public:
  explicit Object(const scree_object& table) : table_(table), self_(table.create()) {}
  ~Object() { table_.destroy(self_); }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;

  void* self() const { return self_; }
  std::string number(const std::string& key, double value) { return numbers(key, {value}, 1, 1); }
  std::string vector(const std::string& key, Vector v) { return numbers(key, {v[0], v[1], v[2]}, 1, 3); }
  std::string list(const std::string& key, const std::vector<double>& values) {
    return numbers(key, values, static_cast<uint32_t>(values.size()), 1);
  }
  std::string box(const std::string& key, Vector a, Vector b) {
    return numbers(key, {a[0], a[1], a[2], b[0], b[1], b[2]}, 2, 3);
  }
  std::string numbers(const std::string& key, const std::vector<double>& values, uint32_t rows, uint32_t columns) {
    const uint32_t k = find(key);
    return put(k, {sizeof(scree_value), table_.properties[k].type, values.data(), rows, columns, nullptr, 0, 0});
  }
  std::string texts(const std::string& key, const std::vector<std::string>& words) {
    std::vector<const char*> plain;
    for (const std::string& word : words) plain.push_back(word.c_str());
    const uint32_t k = find(key);
    return put(k, {sizeof(scree_value), table_.properties[k].type, nullptr, 0, 0, plain.data(),
                   static_cast<uint32_t>(plain.size()), 0});
  }
  std::string text(const std::string& key, const std::string& word) { return texts(key, {word}); }
  std::string check() {
    Refused refused;
    if (table_.check != nullptr && table_.check(self_, &refused.table) != 0) return refused.text;
    return "";
  }
  const scree_property& property(const std::string& key) const { return table_.properties[find(key)]; }

 private:
  uint32_t find(const std::string& key) const {
    for (uint32_t k = 0; k < table_.property_count; ++k)
      if (key == table_.properties[k].name) return k;
    throw std::runtime_error("no setting " + key);
  }
  std::string put(uint32_t k, const scree_value& value) {
    Refused refused;
    return table_.set(self_, k, &value, &refused.table) != 0 ? refused.text : "";
  }

  const scree_object& table_;
  void* self_;
};

}  // namespace support
