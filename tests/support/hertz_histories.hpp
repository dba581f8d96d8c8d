#pragma once
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support/paths.hpp"

namespace support {

/// PFC's histories of one contact, tests/laws/hertz_histories.csv: for each case its instants, each with time, overlap,
/// normal force, normal dashpot, shear along x and z, shear dashpot, strain, slip and dashpot energy.
inline std::map<std::string, std::vector<std::vector<double>>> hertz_histories() {
  std::ifstream file(source_dir() + "/tests/laws/hertz_histories.csv");
  std::map<std::string, std::vector<std::vector<double>>> all;
  std::string line;
  while (std::getline(file, line)) {
    if (line[0] == '#' || line.rfind("case", 0) == 0) continue;
    std::istringstream fields(line);
    std::string name, field;
    std::getline(fields, name, ',');
    std::vector<double> instant;
    while (std::getline(fields, field, ',')) instant.push_back(std::stod(field));
    all[name].push_back(instant);
  }
  return all;
}

}  // namespace support
