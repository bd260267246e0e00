// glibc's settings. Depends on nothing.
#include "preview/app/heap.h"

#include <malloc.h>

namespace nephele {

void keepLargeBlocksApart() {
#if defined(__GLIBC__)
  constexpr int kLargeBytes = 256 * 1024;  // a side of 128 pixels of floats; given once, it stays
  ::mallopt(M_MMAP_THRESHOLD, kLargeBytes);
#endif
}

void returnFreeMemory() {
#if defined(__GLIBC__)
  ::malloc_trim(0);
#endif
}

}  // namespace nephele
