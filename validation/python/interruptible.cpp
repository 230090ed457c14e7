#include "validation/python/interruptible.h"

extern "C" {
void openblas_set_num_threads(int) __attribute__((weak));
int openblas_get_num_threads(void) __attribute__((weak));
}

namespace deflect::python {
namespace {

std::mutex mutex;
int alive = 0, before = 0;

bool is_openblas() { return openblas_set_num_threads && openblas_get_num_threads; }

}  // namespace

OneBlasThread::OneBlasThread() {
  if (!is_openblas()) return;
  const std::lock_guard lock(mutex);
  if (alive++ > 0) return;
  before = openblas_get_num_threads();
  openblas_set_num_threads(1);
}

OneBlasThread::~OneBlasThread() {
  if (!is_openblas()) return;
  const std::lock_guard lock(mutex);
  if (--alive == 0) openblas_set_num_threads(before);
}

}  // namespace deflect::python
