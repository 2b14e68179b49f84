#include "base/random.h"

#include <cmath>
#include <numbers>
#include <numeric>

namespace remomask {

namespace {

// Philox 4x32-10 (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3",
// SC 2011); two of the four output words are used.
uint64_t philox(uint64_t key, uint64_t high, uint64_t low) {
  uint32_t c0 = static_cast<uint32_t>(low), c1 = static_cast<uint32_t>(low >> 32);
  uint32_t c2 = static_cast<uint32_t>(high), c3 = static_cast<uint32_t>(high >> 32);
  uint32_t k0 = static_cast<uint32_t>(key), k1 = static_cast<uint32_t>(key >> 32);
  for (int round = 0; round < 10; ++round) {
    const uint64_t p0 = 0xD2511F53ull * c0, p1 = 0xCD9E8D57ull * c2;
    const uint32_t n0 = static_cast<uint32_t>(p1 >> 32) ^ c1 ^ k0;
    const uint32_t n2 = static_cast<uint32_t>(p0 >> 32) ^ c3 ^ k1;
    c1 = static_cast<uint32_t>(p1);
    c3 = static_cast<uint32_t>(p0);
    c0 = n0;
    c2 = n2;
    k0 += 0x9E3779B9u;
    k1 += 0xBB67AE85u;
  }
  return (static_cast<uint64_t>(c1) << 32) | c0;
}

}  // namespace

uint64_t CounterRandom::bits_at(uint64_t counter) const { return philox(seed_, stream_, counter); }

double CounterRandom::uniform_at(uint64_t counter) const {
  return (static_cast<double>(bits_at(counter) >> 11) + 0.5) * 0x1.0p-53;
}

double CounterRandom::normal() {
  const double u = uniform(), v = uniform();
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

size_t CounterRandom::below(size_t bound) {
  return static_cast<size_t>(uniform() * static_cast<double>(bound));
}

std::vector<size_t> CounterRandom::permutation(size_t count) {
  std::vector<size_t> order(count);
  std::iota(order.begin(), order.end(), size_t{0});
  for (size_t i = count; i > 1; --i) std::swap(order[i - 1], order[below(i)]);
  return order;
}

uint64_t mix_seed(uint64_t a, uint64_t b, uint64_t c) { return philox(a, b, c); }

}  // namespace remomask
