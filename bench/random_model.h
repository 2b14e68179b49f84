#pragma once

#include <map>
#include <string>

#include "encoders/sentence_encoder.h"
#include "nn/model_file.h"
#include "training/presets.h"

namespace remomask {

/// A tokenizer with random weights and codes.
nn::ModelStage random_tokenizer_stage(const tokenizer::TokenizerConfig& config);

/// All stages of a whole model with random weights: as fast as a trained one, but its motions mean
/// nothing.
std::map<std::string, nn::ModelStage> random_stages(training::ModelConfig config,
                                                    const encoders::SentenceEncoder& words);

}  // namespace remomask
