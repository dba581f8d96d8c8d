#include "core/base/heap.hpp"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace scree::core {

void tune_heap() {
#ifdef __GLIBC__
  // Setting it also stops glibc from raising it with every large array that is freed.
  ::mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
}

void return_free_memory() {
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
}

}  // namespace scree::core
