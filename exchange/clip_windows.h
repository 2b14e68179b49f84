#pragma once

#include <vector>

#include "base/time.h"

namespace remomask::exchange {

/// Frames [first, last) of a longer motion.
struct ClipWindow {
  int first = 0, last = 0;
  bool operator==(const ClipWindow&) const = default;
};

struct WindowOptions {
  int min_frames = 20, max_frames = kMaxClipFrames, overlap = 40;
};

/// A motion of up to max_frames + kWindowSlack frames stays whole: the networks
/// ignore the last 0.2 s of such a clip, which is better than cutting it in two (and
/// HumanML3D holds clips of 199 frames).
constexpr int kWindowSlack = kMaxStoredFrames - kMaxClipFrames;

/// Cuts `frames` frames into overlapping windows of max_frames that cover every frame.
/// The last window is flush with the end. If it would add fewer than
/// min_frames new frames, the window before it is moved to the end instead or, if
/// that is the first one, the motion is cut into two equal windows.
/// Throws Error for options that contradict each other.
std::vector<ClipWindow> clip_windows(int frames, const WindowOptions& options);

}  // namespace remomask::exchange
