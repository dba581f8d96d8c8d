#pragma once
#include "core/vet/check.hpp"

/// The checks of a library as a whole. The first ones read the file and run nothing of it.
namespace scree::core::vet {

Outcome exported_symbols(const Subject& subject);
Outcome unshared_symbols(const Subject& subject);
Outcome search_paths(const Subject& subject);
Outcome code_is_constant(const Subject& subject);
Outcome header_sound(const Subject& subject);
Outcome opens(const Subject& subject);
Outcome named_as_file(const Subject& subject);
Outcome start_up_leaves_no_trace(const Subject& subject);

}  // namespace scree::core::vet
