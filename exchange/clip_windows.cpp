#include "exchange/clip_windows.h"

#include "remomask/error.h"

namespace remomask::exchange {

std::vector<ClipWindow> clip_windows(int frames, const WindowOptions& options) {
  const auto [shortest, longest, overlap] = options;
  if (shortest < 2 || longest < shortest || overlap < 0 || overlap > longest - shortest) {
    throw Error(
        "the lengths of the windows contradict each other: min_frames must be 2 or more, "
        "max_frames at least min_frames, and "
        "the overlap at most their difference");
  }
  if (frames <= longest + kWindowSlack) return {{0, frames}};
  std::vector<ClipWindow> windows;
  int first = 0;
  for (; first + longest < frames; first += longest - overlap) {
    windows.push_back({first, first + longest});
  }
  const int new_frames = frames - windows.back().last;
  if (new_frames >= shortest) {
    windows.push_back({frames - longest, frames});
  } else if (windows.size() > 1) {
    windows.back() = {frames - longest, frames};
  } else {
    const int half = (frames + overlap + 1) / 2;
    return {{0, half}, {frames - half, frames}};
  }
  return windows;
}

}  // namespace remomask::exchange
