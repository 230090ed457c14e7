#include "msa/base/memory.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace deflect {

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int MB = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * MB);  // the most that it takes
  mallopt(M_TRIM_THRESHOLD, 512 * MB);
  mallopt(M_TOP_PAD, 16 * MB);
#endif
}

}  // namespace deflect
