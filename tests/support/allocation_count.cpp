// malloc of the C library, counted: operator new and Eigen both end there.
#include "tests/support/allocation_count.h"

#include <atomic>

namespace {
std::atomic<std::size_t> count = 0;
}

extern "C" {
void* __libc_malloc(std::size_t size);
void* malloc(std::size_t size) {
  count.fetch_add(1, std::memory_order_relaxed);
  return __libc_malloc(size);
}
}

namespace deflect::test {

std::size_t allocation_count() { return count; }

}  // namespace deflect::test
