#include "nn/device.h"

#include <ATen/Parallel.h>
#include <omp.h>
#include <torch/cuda.h>

#include "base/error.h"
#include "base/machine.h"

// Only OpenBLAS exports it; with another BLAS the address is null.
extern "C" __attribute__((weak)) void openblas_set_num_threads(int);

namespace remomask {

c10::Device select_device(const std::string& name) {
  if (name.empty() || name == "cpu") return c10::Device(c10::kCPU);
  if (name.rfind("cuda", 0) != 0) {
    throw Error("unknown device \"" + name + "\"; use cpu, cuda or cuda:N");
  }
  if (!torch::cuda::is_available()) {
    throw Error("device \"" + name + "\": this build of libtorch has no CUDA; use --device cpu");
  }
  return c10::Device(name);
}

void set_compute_threads(int threads) {
  if (threads < 0) throw Error("the number of threads must not be negative");
  if (threads == 0) threads = available_cpus();
  at::set_num_threads(threads);
  omp_set_num_threads(threads);
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(threads);
}

}  // namespace remomask
