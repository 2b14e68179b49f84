#pragma once

namespace remomask::nn {

/// Sets the number of CPU threads of libtorch, OpenMP and OpenBLAS; 0: all CPUs that the process
/// may use. OpenMP keeps the number per calling thread, so a library sets it at each entry. Throws
/// Error for a negative number.
void set_compute_threads(int threads);

/// While it lives, libtorch's operators run on the calling thread alone. Convolutions round
/// differently on several threads; what is written to a file must not.
class SerialScope {
 public:
  SerialScope();
  ~SerialScope();
  SerialScope(const SerialScope&) = delete;
  SerialScope& operator=(const SerialScope&) = delete;

 private:
  int threads_before_;
};

}  // namespace remomask::nn
