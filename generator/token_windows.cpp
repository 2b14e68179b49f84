#include "generator/token_windows.h"

#include <torch/types.h>

#include <algorithm>
#include <string>

#include "base/time.h"
#include "generator/ssta.h"
#include "remomask/error.h"

namespace remomask::generator {

std::vector<TokenWindow> plan_windows(const at::Tensor& known, int64_t first, int64_t last) {
  const int64_t frames = known.size(0);
  if (first < 0 || last > frames || first >= last) {
    throw Error("token frames " + std::to_string(first) + " to " + std::to_string(last) +
                " are no stretch of a map of " + std::to_string(frames));
  }
  const auto whole = known.to(torch::kCPU).all(1).contiguous();
  const bool* is_known = whole.data_ptr<bool>();
  int64_t before = 0, after = 0;
  while (before < std::min(kContextTokens, first) && is_known[first - 1 - before]) ++before;
  while (after < std::min(kContextTokens, frames - last) && is_known[last + after]) ++after;
  const int64_t length = last - first;
  if (before + length + after <= kMaxTokenFrames) return {{first - before, last + after}};
  const int64_t most = kMaxTokenFrames - 2 * kContextTokens;
  const int64_t pieces = (length + most - 1) / most;
  std::vector<TokenWindow> windows;
  for (int64_t i = 0; i < pieces; ++i) {
    const int64_t begin = first + length * i / pieces, end = first + length * (i + 1) / pieces;
    windows.push_back(
        {begin - (i == 0 ? before : kContextTokens), i + 1 == pieces ? end + after : end});
  }
  return windows;
}

}  // namespace remomask::generator
