#pragma once
#include <string_view>

#include "core/base/error.hpp"

namespace scree::core {

/// Results go to stdout. A write that fails is a Refusal (exit 6): half a result must not pass for a whole one.
void print(std::string_view text);

/// Tells on stderr why the program ends. A text that names its places ("file:line:column: error: ...") stands as it
/// is, any other gets "error: " before it.
void print_refusal(const Refusal& refusal);

/// A line on stderr as it is, such as a warning of a scene, which names its own place.
void print_note(std::string_view line);

/// Keeps files of the run from being opened as a standard stream that the shell closed: a result would end up in them.
void occupy_standard_streams();

}  // namespace scree::core
