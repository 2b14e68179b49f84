#pragma once

#include <c10/core/Device.h>

#include <string>

namespace remomask {

/// "cpu", "cuda" or "cuda:1". Throws Error when this libtorch has no such device.
c10::Device select_device(const std::string& name);

/// One thread budget for libtorch, OpenMP and OpenBLAS. 0: all available CPUs.
/// Throws Error for a negative number.
void set_compute_threads(int threads);

}  // namespace remomask
