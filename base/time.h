#pragma once

#include <cmath>
#include <cstddef>

namespace remomask {

/// Frames a second of the motions that are made, searched and learnt: HumanML3D's rate.
inline constexpr double kFps = 20;

/// The time of a frame at kFps, in seconds from the first one.
constexpr double seconds_of(size_t frame) { return static_cast<double>(frame) / kFps; }

/// The number of frames that `seconds` last at kFps, to the nearest.
inline int frames_in(double seconds) { return static_cast<int>(std::lround(seconds * kFps)); }

}  // namespace remomask
