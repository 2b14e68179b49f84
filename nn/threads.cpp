#include "nn/threads.h"

#include <ATen/Parallel.h>
#include <omp.h>

#include "base/machine.h"
#include "remomask/error.h"

// Only OpenBLAS exports it; with another BLAS the address is null.
extern "C" __attribute__((weak)) void openblas_set_num_threads(int);

namespace remomask::nn {

void set_compute_threads(int threads) {
  if (threads < 0) throw Error("the number of threads must not be negative");
  if (threads == 0) threads = available_cpus();
  at::set_num_threads(threads);
  omp_set_num_threads(threads);
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(threads);
}

// OpenMP's own number alone, which is one of the calling thread: at::set_num_threads() would change
// it for the threads that are started later, too.
SerialScope::SerialScope() : threads_before_(omp_get_max_threads()) { omp_set_num_threads(1); }
SerialScope::~SerialScope() { omp_set_num_threads(threads_before_); }

}  // namespace remomask::nn
