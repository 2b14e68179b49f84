#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/preset.h"
#include "base/time.h"
#include "motion/feature_mode_json.h"
#include "motion/features.h"

namespace remomask::evaluation {

/// Sizes of the text-motion evaluator (Guo et al., CVPR 2022). The defaults are
/// the preset `base`.
struct EvaluatorConfig {
  std::string preset = "base";
  std::string skeleton = "humanml3d";
  motion::FeatureMode mode = motion::FeatureMode::fixed;
  int64_t movement_width = 256;  ///< of the convolutions and of their output
  int64_t motion_hidden = 256;   ///< of the GRU over movement tokens, each direction
  int64_t text_hidden = 192;     ///< of the GRU over words, each direction
  int64_t word_width = 96;
  int64_t embedding = 128;  ///< E
  int64_t max_words = 20;   ///< of a caption that are read
  int64_t max_frames = kMaxClipFrames;
  /// Root velocity and height count this many times more than their deviation.
  double root_weight = 5;
  std::vector<std::string> vocabulary;  ///< "sos", "eos", "unk", words; made by the training
};

/// "tiny" (tests), "base" (default) or "paper" (sizes of the publication).
/// Throws Error for another name.
EvaluatorConfig evaluator_preset(ModelSize size);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EvaluatorConfig, preset, skeleton, mode, movement_width,
                                   motion_hidden, text_hidden, word_width, embedding, max_words,
                                   max_frames, root_weight, vocabulary)

}  // namespace remomask::evaluation
