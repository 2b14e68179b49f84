#include "generator/dropout.h"

#include <ATen/Parallel.h>
#include <torch/types.h>

#include <cmath>

namespace remomask {

at::Tensor counter_dropout(const at::Tensor& x, double rate, bool training) {
  if (!training || rate <= 0) return x;
  const auto seed = static_cast<uint64_t>(
      torch::randint(std::numeric_limits<int64_t>::max(), {1}, torch::kLong).item<int64_t>());
  const auto threshold = static_cast<uint64_t>(std::llround(rate * 65536));
  const float scale = static_cast<float>(65536.0 / (65536.0 - static_cast<double>(threshold)));
  at::Tensor mask = torch::empty(x.sizes(), torch::kFloat);
  float* values = mask.data_ptr<float>();
  const int64_t count = mask.numel();
  // Four 16-bit draws from every 64-bit mix (splitmix64).
  at::parallel_for(0, (count + 3) / 4, 4096, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
      uint64_t bits = seed + static_cast<uint64_t>(i) * 0x9e3779b97f4a7c15u;
      bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
      bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
      bits ^= bits >> 31;
      const int64_t last = std::min<int64_t>(count, 4 * i + 4);
      for (int64_t j = 4 * i; j < last; ++j, bits >>= 16) {
        values[j] = (bits & 0xffff) < threshold ? 0.f : scale;
      }
    }
  });
  return x * mask.to(x.options());
}

}  // namespace remomask
