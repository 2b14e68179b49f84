#pragma once

#include <string>
#include <vector>

#include "base/random.h"
#include "encoders/text_tower.h"
#include "nn/model_file.h"
#include "remomask/progress.h"
#include "training/trainer.h"

namespace remomask::training {

/// Tokens hidden for masked-word training (BERT, Devlin et al. 2019).
struct MaskedWords {
  at::Tensor ids;     ///< [B, S] with 15 % of the words hidden
  at::Tensor target;  ///< [B, S] the true id at hidden places, -100 elsewhere
};

/// Chooses `share` of the word tokens (at least one a caption): 80 % become
/// [MASK], 10 % a random word, 10 % stay. [CLS], [SEP] and pads never.
MaskedWords mask_words(const encoders::TokenBatch& batch, int64_t vocabulary_size, double share,
                       CounterRandom& random);

struct TextTrainingOptions {
  TrainerOptions trainer;
  int64_t batch = 64;
  double mask_share = 0.15;
  int64_t validation_every = 500;
  TextTrainingOptions();
};

/// Learns the vocabulary (unless `config` has one) and pre-trains the text
/// encoder on all captions by masked words; every 20th caption is held back
/// for the figures. Result: ModelStage "text". Throws Error when fewer than
/// 20 captions are left after normalisation.
nn::ModelStage train_text_encoder(const std::vector<std::string>& captions,
                                  encoders::TextEncoderConfig config,
                                  const TextTrainingOptions& options, const Monitor& monitor);

}  // namespace remomask::training
