#pragma once

namespace scree::core {

/// The whole program: parses the command line, runs one command, returns the exit code.
int run_program(int count, char** words);

}  // namespace scree::core
