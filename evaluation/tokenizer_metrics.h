#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "db/training_set.h"
#include "tokenizer/tokenizer_network.h"

namespace remomask::evaluation {

/// Errors of one reconstruction, means over all frames, in millimetres (for
/// KIT: thousandths of its unit).
struct ReconstructionErrors {
  double mpjpe = 0;         ///< root of each frame subtracted (MoMask's MPJPE)
  double global_mpjpe = 0;  ///< in the world, both start at the origin
  double bone_length = 0;   ///< |length - length of the skeleton in the original|
  double foot_skate = 0;    ///< mm a frame a foot slides horizontally where the original's foot
                            ///< stands (moves less than 5 mm a frame)
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReconstructionErrors, mpjpe, global_mpjpe, bone_length,
                                   foot_skate)

/// Adds up the errors of several batches.
class ReconstructionSums {
 public:
  explicit ReconstructionSums(const Skeleton& skeleton);

  /// World positions [B, T, J, 3] in metres; every frame is real.
  void add(const at::Tensor& output, const at::Tensor& target);
  /// Means so far; all zero before the first batch.
  ReconstructionErrors errors() const;

 private:
  const Skeleton& skeleton_;
  std::vector<int64_t> feet_;
  double frames_ = 0, mpjpe_ = 0, global_ = 0, bones_ = 0, skate_ = 0, standing_ = 0;
};

struct TokenizerMetrics {
  int64_t clips = 0, frames = 0;
  ReconstructionErrors all_levels, base_level;
  std::vector<double> code_use;    ///< per level: share of codes used, mean over codebooks
  std::vector<double> perplexity;  ///< per level: exp(entropy) of the codes, mean over codebooks
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TokenizerMetrics, clips, frames, all_levels, base_level,
                                   code_use, perplexity)

/// Encodes and decodes clips at their true length (a multiple of 4; clips of
/// fewer than 4 frames are left out), in batches of equal length.
TokenizerMetrics measure_tokenizer(tokenizer::TokenizerNetwork& network,
                                   const std::vector<const motion::Features*>& clips);

/// Pointers to the features of all clips.
std::vector<const motion::Features*> clip_features(const std::vector<db::TrainingClip>& clips);

}  // namespace remomask::evaluation
