#include "nn/threads.h"

#include <ATen/Parallel.h>
#include <omp.h>

#include <mutex>

#include "base/machine.h"
#include "remomask/error.h"

// Only OpenBLAS exports them; with another BLAS the addresses are null.
extern "C" __attribute__((weak)) void openblas_set_num_threads(int);
extern "C" __attribute__((weak)) int openblas_get_num_threads();

namespace remomask::nn {

namespace {

/// OpenBLAS has one number of threads for the whole process: while any scope lives, it is 1.
struct SerialBlas {
  std::mutex mutex;
  int scopes = 0, threads_before = 1;

  void enter() {
    const std::scoped_lock lock(mutex);
    if (scopes++ > 0 || openblas_set_num_threads == nullptr) return;
    threads_before = openblas_get_num_threads();
    openblas_set_num_threads(1);
  }
  void leave() {
    const std::scoped_lock lock(mutex);
    if (--scopes > 0 || openblas_set_num_threads == nullptr) return;
    openblas_set_num_threads(threads_before);
  }
  void set(int threads) {
    const std::scoped_lock lock(mutex);
    if (openblas_set_num_threads == nullptr) return;
    if (scopes > 0) {
      threads_before = threads;
    } else {
      openblas_set_num_threads(threads);
    }
  }
};

SerialBlas& serial_blas() {
  static SerialBlas blas;
  return blas;
}

}  // namespace

void set_compute_threads(int threads) {
  if (threads < 0) throw Error("the number of threads must not be negative");
  if (threads == 0) threads = available_cpus();
  at::set_num_threads(threads);
  omp_set_num_threads(threads);
  serial_blas().set(threads);
}

// OpenMP's own number, which is one of the calling thread: at::set_num_threads() would change it
// for the threads that are started later, too.
SerialScope::SerialScope() : threads_before_(omp_get_max_threads()) {
  omp_set_num_threads(1);
  serial_blas().enter();
}

SerialScope::~SerialScope() {
  omp_set_num_threads(threads_before_);
  serial_blas().leave();
}

}  // namespace remomask::nn
