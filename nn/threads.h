#pragma once

namespace remomask::nn {

/// One thread budget for libtorch, OpenMP and OpenBLAS. 0: all available CPUs.
/// Throws Error for a negative number.
void set_compute_threads(int threads);

}  // namespace remomask::nn
