#include "core/plugin/table_copy.hpp"

#include <algorithm>
#include <cstring>
#include <deque>
#include <vector>

#include "core/plugin/first_size.hpp"

namespace scree::core {
namespace {

constexpr uint32_t largest_property = 4096;  // bytes

/// What a copied table points to.
using Lists = std::deque<std::vector<scree_property>>;

template <class T>
struct Copied {
  T table{};
  Lists lists;
};

uint32_t size_of(const void* record) {
  uint32_t size;
  std::memcpy(&size, record, sizeof size);
  return size;
}

/// The common part of a library's struct and ours; the rest of ours stays zero.
template <class T>
void copy_struct(T& to, const void* from) {
  std::memcpy(static_cast<void*>(&to), from, std::min<std::size_t>(size_of(from), sizeof to));
  to.struct_size = sizeof to;
}

/// The records of a library stand as far apart as its own struct is long.
const scree_property* copy_properties(const scree_property* rows, uint32_t count, Lists& lists,
                                      const TableRefusal& refuse, bool columns = false) {
  if (count > 1024 || (count > 0 && rows == nullptr)) refuse("its list of properties is not sound");
  if (count == 0) return nullptr;
  const auto* first = reinterpret_cast<const char*>(rows);
  const uint32_t stride = size_of(first);
  std::vector<scree_property>& own = lists.emplace_back(count);
  for (uint32_t k = 0; k < count; ++k) {
    const char* record = first + std::size_t{k} * stride;
    const uint32_t size = size_of(record);
    if (size < first_size<scree_property> || size > largest_property || size % alignof(scree_property) != 0 ||
        size != stride)
      refuse("property " + std::to_string(k + 1) + " has " + std::to_string(size) + " bytes, " +
             (k > 0 && size != stride ? "the first one " + std::to_string(stride)
                                      : "at least " + std::to_string(first_size<scree_property>) + " are needed"));
    copy_struct(own[k], record);
  }
  for (scree_property& property : own)
    if (property.type == SCREE_TABLE && !columns)  // a table in a table is refused by the check that follows
      property.columns = copy_properties(property.columns, property.column_count, lists, refuse, true);
  return own.data();
}

template <class T>
std::shared_ptr<const void> copied(const void* table, const TableRefusal& refuse) {
  const uint32_t size = size_of(table);
  if (size < first_size<T>)
    refuse("its table has " + std::to_string(size) + " bytes, at least " + std::to_string(first_size<T>) +
           " are needed");
  const auto copy = std::make_shared<Copied<T>>();
  copy_struct(copy->table, table);
  const auto take_list = [&](auto& owner) {
    owner.properties = copy_properties(owner.properties, owner.property_count, copy->lists, refuse);
  };
  if constexpr (requires { copy->table.object; }) {
    if (copy->table.object.struct_size != first_size<scree_object>)
      refuse("its object has " + std::to_string(copy->table.object.struct_size) + " bytes, " +
             std::to_string(first_size<scree_object>) + " are needed");
    take_list(copy->table.object);
  } else {
    take_list(copy->table);
  }
  return {copy, &copy->table};
}

}  // namespace

std::shared_ptr<const void> copy_table(Kind kind, const void* table, const TableRefusal& refuse) {
  if (table == nullptr) refuse("its description failed, so there is nothing to use");
  switch (kind) {
    case Kind::contact_model:
      return copied<scree_contact_model>(table, refuse);
    case Kind::wall:
      return copied<scree_wall>(table, refuse);
    case Kind::generator:
      return copied<scree_generator>(table, refuse);
    case Kind::process:
      return copied<scree_process>(table, refuse);
    case Kind::writer:
      return copied<scree_writer>(table, refuse);
  }
  refuse("its kind is unknown");
}

}  // namespace scree::core
