#include "core/cli/program.hpp"

int main(int count, char** words) { return scree::core::run_program(count, words); }
