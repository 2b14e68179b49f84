#pragma once

#include <string>

#include "generator/tokenizer_training.h"
#include "generator/transformer_training.h"
#include "text/masked_words.h"

namespace remomask {

/// How long and how each network of a preset is trained unless the user says
/// otherwise: "tiny" for tests, "base" as the shipped model was made, "paper"
/// and "momask" as published (MoMask section 4, ReMoMask section 4.1).
TextTrainingOptions text_training_preset(const std::string& preset);
TokenizerTrainingOptions tokenizer_training_preset(const std::string& preset);
TransformerTrainingOptions masked_training_preset(const std::string& preset);
TransformerTrainingOptions residual_training_preset(const std::string& preset);

}  // namespace remomask
