#pragma once

#include <string>
#include <vector>

#include "base/preset.h"
#include "generator/masked_transformer.h"
#include "generator/residual_transformer.h"
#include "retriever/config.h"
#include "tokenizer/tokenizer.h"

namespace remomask::training {

/// Sizes of all networks of one model.
struct ModelConfig {
  tokenizer::TokenizerConfig tokenizer;
  retriever::RetrieverConfig retriever;
  generator::MaskedConfig masked;
  generator::ResidualConfig residual;
};

/// The sizes of a preset: paper are those of ReMoMask (masked 6 x 512, residual 6 x 384, codes
/// 256 x 1024), momask those of MoMask (one row, no retrieval, ordinary attention, 8 x 384, codes
/// 512 x 512).
ModelConfig model_preset(const Preset& preset);

/// MoMask's design in the sizes of `model`: one row for the whole body with twice
/// the codes, convolutions wide enough for about as many weights, ordinary
/// attention, no retrieval.
void use_one_row(ModelConfig& model);

}  // namespace remomask::training
