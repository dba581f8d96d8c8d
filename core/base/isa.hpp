#pragma once
#include <string>
#include <string_view>

namespace scree::core {

/// Instruction sets for which plug-ins and kernel stages carry code. All give the same bits; they differ in speed.
enum class Isa : int { baseline = 0, v3 = 1, v4 = 2 };

const char* isa_name(Isa isa);  ///< "baseline", "v3", "v4"
Isa detect_isa();               ///< the best one that this CPU and this kernel of the operating system support
/// Reads the value of --isa. Throws Refusal(Exit::usage) for an unknown word or one this CPU lacks.
Isa parse_isa(std::string_view word);

/// The entry for `isa` of a table in ABI order, or the last one before it that exists; null when there is none.
template <class Function>
Function* pick(Function* const (&table)[3], Isa isa) {
  for (int k = static_cast<int>(isa); k >= 0; --k)
    if (table[k]) return table[k];
  return nullptr;
}

}  // namespace scree::core
