// libFuzzer entry of the scene reader: any text is read or refused, never a crash, a hang or a leak.
// clang++ -fsanitize=fuzzer,address,undefined with core/scene/*.cpp, core/base/nearest.cpp, core/base/error.cpp,
// core/plugin/*.cpp and tests/unit/scene_fakes.cpp; start it with the folder tests/scenes_broken as its corpus.
#include <cstddef>
#include <cstdint>

#include "unit/scene_fakes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace scree::core;
  try {
    const Scene scene = read_text_scene(std::string(reinterpret_cast<const char*>(bytes), size));
    if (read_text_scene(scene.resolved).resolved != scene.resolved) __builtin_trap();
  } catch (const Refusal& refusal) {
    if (refusal.code() == Exit::internal) __builtin_trap();
  }
  return 0;
}
