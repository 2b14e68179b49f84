#pragma once

#include <ATen/record_function.h>

namespace remomask {

/// Counts the multiplications and additions of the matrix products and convolutions that libtorch
/// and the program's own attention run during its lifetime, on all threads, forward and backward.
/// One multiply-add counts as two. Recurrent layers count as the products that they consist of.
/// Only one may exist at a time.
class FlopCounter {
 public:
  FlopCounter();
  ~FlopCounter();
  FlopCounter(const FlopCounter&) = delete;
  FlopCounter& operator=(const FlopCounter&) = delete;

  double count() const;

 private:
  at::CallbackHandle callback_;
};

}  // namespace remomask
