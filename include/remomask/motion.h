#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "remomask/export.h"
#include "remomask/skeleton.h"

namespace remomask {

/// Joint positions over time, with the skeleton and the frame rate that they belong to.
struct REMOMASK_API Motion {
  int frames = 0;
  int joints = 22;
  std::vector<float> positions;        ///< [frames][joints][3], metres, Y up
  double fps = 20;                     ///< frames per second
  std::string skeleton = "humanml3d";  ///< see skeleton_named()

  Motion() = default;
  Motion(int frame_count, int joint_count)
      : frames(frame_count),
        joints(joint_count),
        positions(static_cast<size_t>(frame_count) * joint_count * 3, 0.f) {}

  double seconds() const { return frames / fps; }

  /// The x, y and z of one joint. Neither index is checked.
  float* at(int frame, int joint) {
    return positions.data() + (static_cast<size_t>(frame) * joints + joint) * 3;
  }
  const float* at(int frame, int joint) const {
    return positions.data() + (static_cast<size_t>(frame) * joints + joint) * 3;
  }
};

/// Frames [first, last) of a motion. Throws Error for frames outside of it.
REMOMASK_API Motion slice(const Motion& motion, int first, int last);

}  // namespace remomask
