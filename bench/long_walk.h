#pragma once

#include "motion/vector.h"
#include "synthetic/procedural.h"

namespace remomask {

/// `frames` frames of a procedural walk that goes back and forth without a jump.
inline Motion long_walk(int frames) {
  synthetic::ProceduralParameters parameters;
  parameters.duration = 9;
  const Motion walk = synthetic::make_procedural_clip("walk-forward", parameters).motion;
  const int period = 2 * walk.frames - 2;
  Motion result(frames, walk.joints);
  for (int frame = 0; frame < frames; ++frame) {
    const int phase = frame % period;
    const int source = phase < walk.frames ? phase : period - phase;
    for (int joint = 0; joint < walk.joints; ++joint) {
      set_joint_position(result, frame, joint, joint_position(walk, source, joint));
    }
  }
  return result;
}

}  // namespace remomask
