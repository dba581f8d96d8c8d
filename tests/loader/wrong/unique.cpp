// Without hidden visibility g++ gives this variable a binding that all libraries of a process share.
#include <scree/abi.h>

template <class T>
struct Counter {
  static inline int count = 0;
};
extern "C" const scree_plugin_header scree_plugin;
const scree_plugin_header scree_plugin = {
    SCREE_MAGIC, sizeof(scree_plugin_header), SCREE_ABI_MAJOR, SCREE_ABI_MINOR, SCREE_SDK_VERSION, "C++",
    0,           sizeof(scree_component),     nullptr};
__attribute__((visibility("hidden"))) int* use_counter() { return &Counter<int>::count; }
