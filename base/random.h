#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace remomask {

/// Counter-based random numbers: the value depends on (seed, stream, counter)
/// alone, so a sample draws the same numbers alone or in a batch, on any
/// number of threads, before or after a resume.
class CounterRandom {
 public:
  explicit CounterRandom(uint64_t seed, uint64_t stream = 0) : seed_(seed), stream_(stream) {}

  /// Value number `counter` of this stream; does not advance.
  uint64_t bits_at(uint64_t counter) const;
  /// In (0, 1), never 0 or 1.
  double uniform_at(uint64_t counter) const;

  uint64_t bits() { return bits_at(counter_++); }
  double uniform() { return uniform_at(counter_++); }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal (Box-Muller; takes two counters).
  double normal();
  /// Uniform in 0 .. bound-1; bound > 0.
  size_t below(size_t bound);
  /// Fisher-Yates permutation of 0 .. count-1.
  std::vector<size_t> permutation(size_t count);

 private:
  uint64_t seed_, stream_, counter_ = 0;
};

/// Mixes several numbers into one seed.
uint64_t mix_seed(uint64_t a, uint64_t b, uint64_t c = 0);

}  // namespace remomask
