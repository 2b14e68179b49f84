#pragma once

#include <optional>

#include "generator/masked_transformer.h"
#include "generator/residual_transformer.h"
#include "remomask/progress.h"
#include "training/generator_data.h"
#include "training/trainer.h"

namespace remomask::training {

struct TransformerTrainingOptions {
  TrainerOptions trainer;
  int64_t batch = 64;
  double noise_hits = 0.1;          ///< share of hits replaced by distant ranks
  double unfamiliar_hits = 0.3;     ///< share of samples with TokenSplit::unfamiliar_hits
  double text_drop = 0.1;           ///< residual model: share of samples without text
  double history_corruption = 0.0;  ///< residual model: share of lower tokens made random
  /// A transformer of this kind whose weights the training goes on from, where their shapes fit.
  std::optional<nn::ModelStage> start;
  int64_t validate_every = 500;
  size_t validation_clips = 256;  ///< at most so many, evenly spread
};

/// What decides what is learnt, but for TrainerOptions: identifies a run.
nlohmann::json options_document(const TransformerTrainingOptions& options);

/// Trains the masked transformer on the base level. Masks (masking.h), drops
/// of conditions, hits, captions and frame offsets are functions of (seed,
/// step, sample). Validation reports loss and accuracy on `val` with both
/// conditions, the accuracy with TokenSplit::unfamiliar_hits, and with text alone. Sizes of map,
/// text and embedding are taken from the data; the history is in config["history"].
nn::ModelStage train_masked(generator::MaskedConfig config, const GeneratorData& data,
                            const TransformerTrainingOptions& options, const Monitor& monitor);

/// Trains the residual transformer on levels drawn uniformly from 1 ..
/// levels-1, given the true levels below.
nn::ModelStage train_residual(generator::ResidualConfig config, const GeneratorData& data,
                              const TransformerTrainingOptions& options, const Monitor& monitor);

}  // namespace remomask::training
