#include "training/masking.h"

#include <algorithm>
#include <cmath>

namespace remomask::training {

namespace {

int64_t rounded_share(double ratio, int64_t count) {
  return std::clamp<int64_t>(std::llround(ratio * static_cast<double>(count)), 1, count);
}

}  // namespace

MaskKind draw_mask_kind(int64_t rows, CounterRandom& random) {
  const double u = random.uniform();
  if (u < 0.5) return MaskKind::time_space;
  if (u < 0.75) return MaskKind::random;
  if (u < 0.9) return rows > 1 ? MaskKind::rows : MaskKind::random;
  return MaskKind::section;
}

std::vector<bool> draw_mask(MaskKind kind, int64_t frames, int64_t rows, double ratio,
                            CounterRandom& random) {
  const int64_t count = frames * rows;
  std::vector<bool> mask(static_cast<size_t>(count), false);
  const auto mark_frame = [&](int64_t frame) {
    for (int64_t row = 0; row < rows; ++row) mask[static_cast<size_t>(frame * rows + row)] = true;
  };
  if (kind == MaskKind::time_space) {
    const auto order = random.permutation(static_cast<size_t>(frames));
    const int64_t chosen = rounded_share(ratio, frames);
    for (int64_t i = 0; i < chosen; ++i) mark_frame(static_cast<int64_t>(order[i]));
  }
  if (kind == MaskKind::time_space || kind == MaskKind::random) {
    const auto order = random.permutation(static_cast<size_t>(count));
    const int64_t chosen = rounded_share(ratio, count);
    for (int64_t i = 0; i < chosen; ++i) mask[order[static_cast<size_t>(i)]] = true;
  } else if (kind == MaskKind::rows) {
    const auto order = random.permutation(static_cast<size_t>(rows));
    const size_t chosen = 1 + random.below(static_cast<size_t>(std::max<int64_t>(1, rows - 1)));
    for (size_t i = 0; i < chosen; ++i) {
      for (int64_t frame = 0; frame < frames; ++frame) {
        mask[static_cast<size_t>(frame * rows) + order[i]] = true;
      }
    }
  } else if (kind == MaskKind::section) {
    const int64_t length = rounded_share(ratio, frames);
    const auto start = static_cast<int64_t>(random.below(static_cast<size_t>(frames - length + 1)));
    for (int64_t frame = start; frame < start + length; ++frame) mark_frame(frame);
  }
  return mask;
}

int64_t corrupt_token(int64_t token, int64_t codes, int64_t mask_token, CounterRandom& random) {
  const double u = random.uniform();
  const auto code = static_cast<int64_t>(random.below(static_cast<size_t>(codes)));
  return u < 0.8 ? mask_token : u < 0.9 ? code : token;
}

ConditionDrop draw_condition_drop(CounterRandom& random) {
  const double u = random.uniform();
  if (u < 0.10) return {false, false};
  if (u < 0.15) return {true, false};
  if (u < 0.20) return {false, true};
  return {true, true};
}

}  // namespace remomask::training
