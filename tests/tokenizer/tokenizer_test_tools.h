#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "db/training_set.h"
#include "motion/canonical.h"
#include "motion/vector.h"
#include "tokenizer/tokenizer.h"

namespace remomask {

/// A body that walks on a curve and swings its limbs; `kind` changes speeds.
inline motion::Features swinging_features(int frames, int kind) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion motion(frames, skeleton.joints());
  for (int t = 0; t < frames; ++t) {
    const double time = t / skeleton.fps;
    const Quat heading(Eigen::AngleAxisd(0.3 * kind * time, Vec3::UnitY()));
    set_joint_position(motion, t, 0,
                       Vec3(0.2 * kind * std::sin(time), 0.9 + 0.02 * std::sin(6 * time), time));
    for (int j = 1; j < skeleton.joints(); ++j) {
      const double swing = 0.4 * std::sin((3 + kind) * time + j);
      const Quat turn = heading * Quat(Eigen::AngleAxisd(swing, Vec3::UnitX()));
      set_joint_position(motion, t, j,
                         joint_position(motion, t, skeleton.parents[j]) +
                             turn * (skeleton.bone_lengths[j] * rest_direction(skeleton, j)));
    }
  }
  return motion::extract_features_all_frames(motion::canonicalize(motion, skeleton), skeleton,
                                             motion::FeatureMode::fixed);
}

inline std::vector<db::TrainingClip> swinging_clips(const std::vector<int>& lengths) {
  std::vector<db::TrainingClip> clips;
  for (size_t i = 0; i < lengths.size(); ++i) {
    db::TrainingClip clip;
    clip.clip_id = static_cast<int64_t>(i + 1);
    clip.name = "clip" + std::to_string(i);
    clip.features = swinging_features(lengths[i], static_cast<int>(i % 4));
    clips.push_back(clip);
  }
  return clips;
}

inline tokenizer::TokenizerConfig small_tokenizer_config() {
  tokenizer::TokenizerConfig config;
  config.preset = "test";
  config.levels = 3;
  config.codes = 16;
  config.code_width = 8;
  config.widths = {24};
  config.blocks = {2};
  config.mixer_width = 32;
  config.smooth_width = 8;
  return config;
}

}  // namespace remomask
