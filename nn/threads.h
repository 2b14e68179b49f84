#pragma once

namespace remomask::nn {

/// Sets the number of CPU threads of libtorch, OpenMP and OpenBLAS; 0: all CPUs that the process
/// may use. OpenMP keeps the number per calling thread, so a library sets it at each entry. Throws
/// Error for a negative number.
void set_compute_threads(int threads);

}  // namespace remomask::nn
