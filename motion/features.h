#pragma once

#include <string>
#include <vector>

#include "remomask/motion.h"

namespace remomask::motion {

/// How features are computed. `official` reproduces HumanML3D bit for bit with its historical
/// defects (for evaluation and imported weights). `fixed` has the true facing direction, no wrap at
/// 180 degrees, no spike in frame 0, and rotations free of the heading (for our own training).
enum class FeatureMode { official, fixed };

FeatureMode parse_feature_mode(const std::string& name);
const char* feature_mode_name(FeatureMode mode);

/// HumanML3D features, one row per frame (12 J - 1 = 263 columns): 0 root yaw velocity (half angle,
/// rad/frame), 1-2 root velocity x, z in the facing frame (m/frame), 3 root height, 4-66 local
/// positions of joints 1..21, 67-192 their 6D rotations, 193-258 velocities of joints 0..21,
/// 259-262 contacts (left ankle, left toe, right ankle, right toe).
struct Features {
  int frames = 0;
  int dim = 263;
  std::vector<float> values;  ///< [frames][dim]

  Features() = default;
  Features(int frame_count, int dimension)
      : frames(frame_count),
        dim(dimension),
        values(static_cast<size_t>(frame_count) * dimension, 0.f) {}
  float* row(int frame) { return values.data() + static_cast<size_t>(frame) * dim; }
  const float* row(int frame) const { return values.data() + static_cast<size_t>(frame) * dim; }
};

/// Converts canonical positions of N frames to N - 1 rows (Guo et al., CVPR 2022). Throws Error for
/// fewer than 2 frames or values that are not finite.
Features extract_features(const Motion& canonical, const Skeleton& skeleton, FeatureMode mode);

/// The same with as many rows as frames: the motion is first extended by one frame of constant
/// velocity.
Features extract_features_all_frames(const Motion& canonical, const Skeleton& skeleton,
                                     FeatureMode mode);

/// HumanML3D's recover_from_ric: converts T rows to T frames of joint positions.
Motion recover_motion(const Features& features, const Skeleton& skeleton);

/// Also recovers the frame after the last row, from its velocity block, so that features of the
/// recovered positions have as many rows as before.
Motion recover_motion_with_next_frame(const Features& features, const Skeleton& skeleton);

}  // namespace remomask::motion
