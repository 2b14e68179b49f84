#pragma once

#include <ATen/core/Tensor.h>

#include <cstdint>
#include <vector>

namespace remomask::generator {

/// Token frames [first, last) that the transformers see at once, at most
/// kMaxTokenFrames.
struct TokenWindow {
  int64_t first = 0, last = 0;
};

/// Token frames of known motion that a window shows on a side, where there are
/// as many: 1.6 s.
constexpr int64_t kContextTokens = 8;

/// The windows in which token frames [first, last) of a map are filled, one
/// after the other; known is bool [T, rows]. A stretch that fits is one window
/// with the frames around it that are known as a whole, up to kContextTokens a side. A
/// longer one is cut into pieces of nearly equal length; the first of them sees the known
/// frames before the stretch, each further one the end of the piece before, the last one
/// also the known frames behind. Throws Error for frames outside of the map.
std::vector<TokenWindow> plan_windows(const at::Tensor& known, int64_t first, int64_t last);

}  // namespace remomask::generator
