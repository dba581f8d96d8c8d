#pragma once
// What tests of saved states share: the plug-ins of this build, a text changed in one place, a run, and a file of it.
#include <string>

#include "core/run/state.hpp"
#include "support/catch.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

namespace support {

inline scree::core::SearchPath plugins_of_build() {
  scree::core::SearchPath path;
  path.others = {plugin_dir()};
  return path;
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

inline void run(scree::core::Simulation& simulation, uint64_t cycles) {
  for (uint64_t k = 0; k < cycles; ++k) simulation.engine.advance();
}

inline void save(const scree::core::Simulation& simulation, const std::string& path) {
  scree::core::ArchiveWriter out(path);
  save_state(simulation, out);
  REQUIRE(out.commit());
}

}  // namespace support
