#pragma once

#include <map>
#include <string>

#include "nn/model_file.h"
#include "training/presets.h"

namespace remomask {

/// A tokenizer with random weights and codes.
nn::ModelStage random_tokenizer_stage(const tokenizer::TokenizerConfig& config);

/// All stages of a whole model with random weights: as fast as a trained one, but its motions mean
/// nothing.
std::map<std::string, nn::ModelStage> random_stages(const training::ModelConfig& config);

}  // namespace remomask
