// malloc, counted: operator new and Eigen both end there. The address sanitizer has a malloc of its own, and tells of
// it.
#include "tests/support/allocation_count.h"

#include <atomic>

#include "tests/support/sanitizers.h"

#ifdef __SANITIZE_ADDRESS__  // Debian's g++ comes without <sanitizer/allocator_interface.h>
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*taken)(const volatile void*, std::size_t),
                                                         void (*given_back)(const volatile void*));
#endif

namespace {
std::atomic<std::size_t> count = 0;
}

#ifdef __SANITIZE_ADDRESS__

namespace {
const int counted = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { count.fetch_add(1, std::memory_order_relaxed); },
    [](const volatile void*) {});
}

#else

extern "C" {
void* __libc_malloc(std::size_t size);
void* malloc(std::size_t size) {
  count.fetch_add(1, std::memory_order_relaxed);
  return __libc_malloc(size);
}
}

#endif

namespace deflect::test {

std::size_t allocation_count() { return count; }

}  // namespace deflect::test
