#pragma once
#include <string>

#include "core/run/run.hpp"

namespace scree::core {

/// The end of a run for a reader at the terminal: how it ended, numbers, expectations, speed, and where the files lie.
std::string report_text(const RunResult& result);

/// Prints the result, as JSON if asked, and returns its exit code.
Exit print_result(const RunResult& result, bool json);

}  // namespace scree::core
