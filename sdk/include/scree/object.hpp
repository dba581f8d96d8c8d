#pragma once
/// From a described struct to the `scree_object` part of a table: create, set, check, destroy. Plug-in authors do not
/// use this header.
#include <scree/abi.h>
#include <scree/refusal.hpp>
#include <scree/settings.hpp>

#include <cmath>
#include <deque>
#include <type_traits>
#include <vector>

namespace scree {

/// The keys of T, described once per library on first use. [one thread]
template <class T>
class Description {
 public:
  static const Description& get() {
    static const Description description;
    return description;
  }
  const std::vector<scree_property>& properties() const { return properties_; }

  T* make() const {
    T* object = new T{};
    for (const auto& entry : entries_)
      if ((entry.property.flags & SCREE_HAS_FALLBACK) != 0 && entry.property.words == 1) {
        const double value = entry.property.fallback;
        entry.store(*object, {sizeof(scree_value), entry.property.type, &value, 1, 1, nullptr, 0, 0});
      }
    return object;
  }
  void set(T& object, uint32_t property, const scree_value& value) const {
    if (property >= entries_.size()) throw std::runtime_error("there is no such setting");
    const auto& entry = entries_[property];
    check_value(entry.property, value);
    entry.store(object, value);
  }

 private:
  Description() {
    Settings<T> settings;
    T::describe(settings);
    entries_ = std::move(settings.entries());
    const T initial{};
    for (auto& entry : entries_) {
      scree_property& property = entry.property;
      const bool silent = (property.flags & (SCREE_REQUIRED | SCREE_HAS_FALLBACK)) == 0;
      if (silent && entry.initial && !std::isnan(entry.initial(initial))) {
        property.fallback = entry.initial(initial);
        property.flags |= SCREE_HAS_FALLBACK;
      }
      property.columns = entry.columns.data();
      property.column_count = static_cast<uint32_t>(entry.columns.size());
      properties_.push_back(property);
    }
  }

  std::deque<typename Settings<T>::Entry> entries_;
  std::vector<scree_property> properties_;
};

template <class T>
concept Described = std::is_default_constructible_v<T> && requires(Settings<T>& settings) {
  T::describe(settings);
};

template <class T>
scree_object object_table() {
  static_assert(Described<T>,
                "scree: a component needs 'static void describe(Settings<T>&)' and must be default constructible");
  const auto& properties = Description<T>::get().properties();
  scree_object table{};
  table.struct_size = sizeof table;
  table.property_count = static_cast<uint32_t>(properties.size());
  table.properties = properties.data();
  table.create = []() -> void* {
    try {
      return Description<T>::get().make();
    } catch (...) {
      return nullptr;
    }
  };
  table.destroy = [](void* self) { delete static_cast<T*>(self); };
  table.set = [](void* self, uint32_t property, const scree_value* value, const scree_refusal* refusal) {
    return guarded(refusal, [&] { Description<T>::get().set(*static_cast<T*>(self), property, *value); });
  };
  if constexpr (requires(T & t) { t.check(); })
    table.check = [](void* self, const scree_refusal* refusal) {
      return guarded(refusal, [&] { static_cast<T*>(self)->check(); });
    };
  return table;
}

}  // namespace scree
