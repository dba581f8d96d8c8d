#include "core/base/isa.hpp"

#include "core/base/error.hpp"

#if defined(__x86_64__)
#include <cpuid.h>
#endif

namespace scree::core {
namespace {

#if defined(__x86_64__)
/// The members of a level that the compiler's own query does not know by name in all supported compilers.
bool has_scalar_part_of_v3() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  if (!__get_cpuid(1, &a, &b, &c, &d)) return false;
  const bool movbe = (c >> 22) & 1u, f16c = (c >> 29) & 1u;
  if (!__get_cpuid(0x80000001u, &a, &b, &c, &d)) return false;
  const bool lzcnt = (c >> 5) & 1u;
  return movbe && f16c && lzcnt;
}
#endif

}  // namespace

const char* isa_name(Isa isa) {
  switch (isa) {
    case Isa::v3:
      return "v3";
    case Isa::v4:
      return "v4";
    default:
      return "baseline";
  }
}

Isa detect_isa() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
                  __builtin_cpu_supports("fma") && has_scalar_part_of_v3();
  if (!v3) return Isa::baseline;
  const bool v4 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  return v4 ? Isa::v4 : Isa::v3;
#else
  return Isa::baseline;
#endif
}

Isa parse_isa(std::string_view word) {
  for (const Isa isa : {Isa::baseline, Isa::v3, Isa::v4}) {
    if (word != isa_name(isa)) continue;
    if (isa > detect_isa())
      throw Refusal(Exit::usage, "--isa " + std::string(word) + ": this CPU lacks it, the best here is " +
                                     isa_name(detect_isa()) + "; leave --isa out to use that");
    return isa;
  }
  throw Refusal(Exit::usage, "--isa " + std::string(word) + ": no such instruction set; use baseline, v3 or v4");
}

}  // namespace scree::core
