#include "generator/dropout.h"

#include <ATen/Parallel.h>
#include <torch/types.h>

#include <cmath>
#include <limits>

namespace remomask::generator {

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
  const auto draw = [&](int64_t four, int64_t wanted) {
    uint64_t bits = seed + static_cast<uint64_t>(four) * 0x9e3779b97f4a7c15u;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    bits ^= bits >> 31;
    for (int64_t j = 0; j < wanted; ++j) {
      values[4 * four + j] = ((bits >> (16 * j)) & 0xffff) < threshold ? 0.f : scale;
    }
  };
  at::parallel_for(0, count / 4, 4096, [&](int64_t begin, int64_t end) {
    for (int64_t four = begin; four < end; ++four) draw(four, 4);
  });
  draw(count / 4, count % 4);
  return x * mask.to(x.options());
}

}  // namespace remomask::generator
