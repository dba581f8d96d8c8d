#pragma once
#include <scree/abi.h>

#include <cstddef>
#include <cstdint>

namespace scree::core {

/// Bytes of a struct in ABI 0.1, the first that is supported: what any library of this major version has at least.
/// Fields that came later are read from a library only as far as its own `struct_size` reaches.
template <class T>
constexpr uint32_t first_size = 0;

#define SCREE_FIRST_SIZE(type, last) \
  template <>                        \
  inline constexpr uint32_t first_size<type> = offsetof(type, last) + sizeof(type::last)
SCREE_FIRST_SIZE(scree_property, choices);
SCREE_FIRST_SIZE(scree_contact_model, normal_only);
SCREE_FIRST_SIZE(scree_object, check);
SCREE_FIRST_SIZE(scree_wall, area);
SCREE_FIRST_SIZE(scree_generator, generate);
SCREE_FIRST_SIZE(scree_process, damping);
SCREE_FIRST_SIZE(scree_writer, load);
SCREE_FIRST_SIZE(scree_component, table);
SCREE_FIRST_SIZE(scree_plugin_header, components);
#undef SCREE_FIRST_SIZE

// These lie inside other structs or in arrays without a stride of their own, so they stay as they are.
static_assert(sizeof(scree_object) == first_size<scree_object>);
static_assert(sizeof(scree_state_word) == 2 * sizeof(char*) + 2 * sizeof(uint32_t));
static_assert(sizeof(scree_need) == 2 * sizeof(uint32_t));
static_assert(sizeof(scree_array) == 3 * sizeof(char*) + 2 * sizeof(uint32_t));
static_assert(sizeof(scree_polygon) == sizeof(double*) + 2 * sizeof(uint32_t));
static_assert(sizeof(scree_wall_picture) == 2 * sizeof(char*) + 2 * sizeof(uint32_t) + 6 * sizeof(double));

}  // namespace scree::core
