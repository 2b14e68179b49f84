#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "db/training_set.h"
#include "remomask/progress.h"
#include "tokenizer/residual_quantizer.h"
#include "tokenizer/tokenizer.h"
#include "training/tokenizer_loss.h"
#include "training/trainer.h"

namespace remomask::training {

struct TokenizerTrainingOptions {
  TrainerOptions trainer;  ///< steps, rate, seed, checkpoint
  tokenizer::CodebookTraining codebooks;
  TokenizerLossOptions loss;
  double commitment = 0.1;      ///< weight of the commitment loss
  int64_t window = 64;          ///< frames of a training window
  int64_t batch_frames = 2048;  ///< frames of a batch: 32 windows of 64
  double long_share = 0.25;     ///< share of steps with windows of 128 or 192 frames, so that the
                                ///< network also sees positions far from both ends
  int64_t validate_every = 500;
  size_t validation_clips = 150;  ///< at most so many, evenly spread

  TokenizerTrainingOptions() {
    trainer.stage_name = "tokenizer";
    trainer.steps = 3500;
    trainer.learning_rate = 1e-3;
    trainer.warmup_steps = 100;
    trainer.ema_decay = 0.99;
  }
};

/// What decides what is learnt, but for TrainerOptions: identifies a run.
nlohmann::json options_document(const TokenizerTrainingOptions& options);

struct FeatureStatistics {
  at::Tensor mean;       ///< [D]
  at::Tensor deviation;  ///< [D], the mean over each group of columns (root yaw, root velocity,
                         ///< height, positions, rotations, velocities, contacts)
};

/// Over all frames of all clips. Throws Error without clips or for columns that
/// never change.
FeatureStatistics feature_statistics(const std::vector<const motion::Features*>& clips,
                                     const Skeleton& skeleton);

/// Trains a tokenizer (MoMask section 3.1). Windows are a function of (seed,
/// step); validation on `val` reports MPJPE in mm of all levels and of the base
/// level, use and perplexity of the codes. The stage's config holds the
/// TokenizerConfig and under "training" the history of validations. Throws
/// Error when no clip is long enough, Interrupted after a checkpoint when asked
/// to stop.
nn::ModelStage train_tokenizer(const std::vector<db::TrainingClip>& train,
                               const std::vector<db::TrainingClip>& val,
                               const tokenizer::TokenizerConfig& config,
                               const TokenizerTrainingOptions& options, const Monitor& monitor);

}  // namespace remomask::training
