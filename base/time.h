#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace remomask {

/// Frames a second of the motions that are made, searched and learnt: HumanML3D's rate.
inline constexpr double kFps = 20;

/// Frames that the networks see at once, and the longest clip that a database holds whole: a clip
/// of up to 200 frames is not worth two windows (exchange/clip_windows.h).
inline constexpr int kMaxClipFrames = 196;
inline constexpr int kMaxStoredFrames = kMaxClipFrames + 4;
inline constexpr double kMaxClipSeconds = kMaxClipFrames / kFps;

/// Poses that one column of a token map stands for, and the columns of the longest map.
inline constexpr int64_t kFramesPerToken = 4;
inline constexpr int64_t kMaxTokenFrames = kMaxClipFrames / kFramesPerToken;

/// Bounds of a motion that is generated, in seconds. Beyond kMaxClipSeconds it is made in pieces.
inline constexpr double kMinMotionSeconds = 1;
inline constexpr double kMaxMotionSeconds = 600;

/// The time of a frame at kFps, in seconds from the first one.
constexpr double seconds_of(size_t frame) { return static_cast<double>(frame) / kFps; }

/// The number of frames that `seconds` last at kFps, to the nearest.
inline int frames_in(double seconds) { return static_cast<int>(std::lround(seconds * kFps)); }

}  // namespace remomask
