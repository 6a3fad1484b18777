#pragma once

// What a program does with memory that is freed.

#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

namespace arcslip {

/// Keeps it, but for blocks of 32 MB and more, where the C library is GNU's: to be given the same pages again
/// can take as long as what is computed in them. To be called before other threads begin.
inline void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
#endif
}

}  // namespace arcslip
