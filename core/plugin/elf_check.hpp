#pragma once
#include <scree/abi.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace scree::core {

/// What the header of a plug-in says of itself, read from the file. Pointers are not valid in this copy.
struct HeaderNumbers {
  uint32_t magic, header_size, abi_major, abi_minor, component_count, component_size;
};

/// What a library asks of the system and of its neighbours.
struct ElfFacts {
  std::vector<std::string> exports;       ///< symbols that other libraries could find, `scree_plugin` included
  std::vector<std::string> shared;        ///< of these, with a binding that is shared between libraries
  std::vector<std::string> search_paths;  ///< RPATH and RUNPATH
  std::vector<std::string> needed;        ///< libraries it asks for
  bool text_relocations = false;          ///< the loader must write into its code
  bool executable_stack = false;
};

/// Reads the same without judging. Throws Refusal(Exit::plugin) only for what is no library of this machine. [any
/// thread]
ElfFacts read_elf(std::span<const std::byte> bytes, const std::filesystem::path& file);

/// Reads a library as bytes, without running any of it, and refuses what must not be loaded: not an x86-64 ELF shared
/// library, other exports than `scree_plugin`, symbols with a binding that is shared between libraries, a search path
/// or a path of its own for other libraries. `file` is for messages. Throws Refusal(Exit::plugin). [any thread]
HeaderNumbers check_elf(std::span<const std::byte> bytes, const std::filesystem::path& file);

}  // namespace scree::core
