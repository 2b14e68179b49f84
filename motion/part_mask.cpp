#include "motion/part_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>

#include "remomask/error.h"

namespace remomask::motion {

namespace {

std::vector<FrameRun> runs_where(int frames, const std::function<bool(int)>& marked) {
  std::vector<FrameRun> runs;
  for (int t = 0; t < frames; ++t) {
    if (!marked(t)) continue;
    if (runs.empty() || runs.back().last != t) runs.push_back({t, t});
    runs.back().last = t + 1;
  }
  return runs;
}

}  // namespace

void PartMask::add(int first, int last, const std::vector<int>& parts) {
  if (first < 0 || last > frames() || first >= last) {
    throw Error(fmt::format("frames {} to {} are not a span of a motion of {} frames", first, last,
                            frames()));
  }
  std::vector<int> marked = parts;
  if (marked.empty()) {
    marked.resize(kBodyParts);
    std::iota(marked.begin(), marked.end(), 0);
  }
  for (const int part : marked) {
    if (part < 0 || part >= kBodyParts) {
      throw Error(fmt::format("there is no body part number {}; they are 0 to 5", part));
    }
    for (int t = first; t < last; ++t) cells_[static_cast<size_t>(t)][part] = true;
  }
}

bool PartMask::whole(int frame) const {
  const auto& row = cells_[static_cast<size_t>(frame)];
  return std::all_of(row.begin(), row.end(), [](bool cell) { return cell; });
}

bool PartMask::any(int frame) const {
  const auto& row = cells_[static_cast<size_t>(frame)];
  return std::any_of(row.begin(), row.end(), [](bool cell) { return cell; });
}

int PartMask::count() const {
  int result = 0;
  for (const auto& row : cells_) {
    result += static_cast<int>(std::count(row.begin(), row.end(), true));
  }
  return result;
}

std::vector<FrameRun> part_runs(const PartMask& mask, int part) {
  return runs_where(mask.frames(), [&](int t) { return mask.has(t, part); });
}

std::vector<FrameRun> whole_runs(const PartMask& mask) {
  return runs_where(mask.frames(), [&](int t) { return mask.whole(t); });
}

}  // namespace remomask::motion
