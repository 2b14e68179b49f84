#pragma once

#include <vector>

#include "db/training_set.h"
#include "evaluation/evaluator_config.h"
#include "nn/model_file.h"
#include "remomask/progress.h"
#include "training/trainer.h"

namespace remomask::training {

struct EvaluatorTrainingOptions {
  TrainerOptions movement;  ///< stage 1: the movement encoder with a decoder
  TrainerOptions trainer;   ///< stage 2: contrastive; its checkpoint_path serves both
  int64_t movement_batch = 128;
  int64_t window = 24;  ///< frames of stage 1
  int64_t batch = 64;
  double margin = 10;  ///< of mismatched pairs
  /// Random cyclic shifts of a batch whose pairs are mismatches, each different
  /// and none 0; at least batch - 1: all pairs.
  int64_t shifts = 63;
  double min_crop = 0.9;   ///< shortest random crop, share of the clip
  double word_drop = 0.1;  ///< share of the words read as unknown
  int64_t validation_every = 100;
  /// Defaults for a network of this size.
  explicit EvaluatorTrainingOptions(ModelSize size = ModelSize::base);
};

/// Pairs (text i, motion j) of a batch that may count as mismatches: another
/// group, another normalised caption, other labels content and style. Bool [B, B].
at::Tensor may_mismatch(const std::vector<const db::TrainingClip*>& clips,
                        const std::vector<std::string>& captions);

/// Mean squared distance of matched pairs (rows of the same number) plus the mean
/// of max(0, margin - distance)^2 over the pairs of `mismatched` (bool [B, B]; 0
/// when there are none).
at::Tensor evaluator_loss(const at::Tensor& text, const at::Tensor& motion,
                          const at::Tensor& mismatched, double margin);

/// Trains the evaluator (Guo et al., CVPR 2022): first the movement encoder as
/// one half of an autoencoder (L1 + 0.001 |z| + 0.001 |z_t - z_(t+1)|), then, with
/// it frozen, text and motion encoder by evaluator_loss(). Returns the stage
/// "evaluator" of the validation with the best R-precision (mean of top 1 to 3 on
/// val, batches with distinct captions), or of the last step without val clips.
/// Stage 1 keeps its checkpoint beside the other one ("PATH.movement"). Throws
/// Error when nothing can be trained.
nn::ModelStage train_evaluator(const std::vector<db::TrainingClip>& train,
                               const std::vector<db::TrainingClip>& val,
                               evaluation::EvaluatorConfig config,
                               const EvaluatorTrainingOptions& options, const Monitor& monitor);

}  // namespace remomask::training
