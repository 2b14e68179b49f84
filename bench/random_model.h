#pragma once

#include <map>
#include <string>

#include "generator/presets.h"
#include "nn/model_file.h"

namespace remomask {

/// A tokenizer with random weights and codes.
ModelStage random_tokenizer_stage(const TokenizerConfig& config);

/// All stages of a whole model with random weights: as fast as a trained one,
/// its motions mean nothing.
std::map<std::string, ModelStage> random_stages(const ModelConfig& config);

}  // namespace remomask
