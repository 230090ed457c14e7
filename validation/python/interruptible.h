// Long work called from Python: without the interpreter's lock, in a thread of its own, while the caller's thread looks
// for Ctrl-C and tells the progress.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "msa/base/outcome.h"
#include "validation/parallel/cases.h"

namespace deflect::python {

/// Ends work from its progress; no Refusal, so that no search takes it for a trial that failed.
struct Interrupted : std::exception {};

/// For its life OpenBLAS, where it is the BLAS, has one thread, as in the program: systems are small, and results are
/// then those of the program to the last digit. The number that NumPy had comes back with the last of these objects.
class OneBlasThread {
 public:
  OneBlasThread();
  ~OneBlasThread();
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;
};

/// The result of work(told). `progress`: None, or called with the share that is done, 0 … 1, up to ten times a second.
/// On Ctrl-C, or where `progress` raises, the work ends when it next tells how far it is, and the exception goes on.
template <class F>
auto interruptible(const pybind11::object& progress, const F& work) {
  std::optional<decltype(work(parallel::Told()))> result;
  std::exception_ptr thrown;
  std::atomic<bool> stop = false;
  std::atomic<double> share = 0;
  std::mutex mutex;
  std::condition_variable ended;
  bool done = false;
  const parallel::Told told = [&](double s) {
    if (stop) throw Interrupted();
    share = s;
  };
  const OneBlasThread one;
  {
    const pybind11::gil_scoped_release released;
    const std::jthread worker([&] {
      thrown = thrown_by([&] { result.emplace(work(told)); });
      const std::lock_guard lock(mutex);
      done = true;
      ended.notify_one();
    });
    struct AtEnd {
      std::atomic<bool>& stop;
      ~AtEnd() { stop = true; }
    } const at_end{stop};
    for (std::unique_lock lock(mutex); !ended.wait_for(lock, std::chrono::milliseconds(100), [&] { return done; });) {
      lock.unlock();
      {
        const pybind11::gil_scoped_acquire acquired;
        if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
        if (!progress.is_none()) progress(share.load());
      }
      lock.lock();
    }
  }
  if (thrown) std::rethrow_exception(thrown);
  if (!progress.is_none()) progress(1.0);
  return std::move(*result);
}

}  // namespace deflect::python
