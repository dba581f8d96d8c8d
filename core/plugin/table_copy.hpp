#pragma once
#include <memory>

#include "core/plugin/catalogue.hpp"
#include "core/plugin/table_refusal.hpp"

namespace scree::core {

/// A library's table in this program's own shape. What a library of an older ABI does not have is zero or null in the
/// copy, so no reader has to look at a `struct_size` again. Refuses structs that are shorter than those of ABI 0.1.
std::shared_ptr<const void> copy_table(Kind kind, const void* table, const TableRefusal& refuse);

}  // namespace scree::core
