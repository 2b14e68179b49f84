#pragma once

#include <string>
#include <vector>

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

/// "tiny" (tests), "small" (comparisons of many models), "base" (default, trained
/// in an hour on a few CPU cores), "paper" (sizes of ReMoMask: masked 6 x 512,
/// residual 6 x 384, codes 256 x 1024), "momask" (one row, no retrieval, ordinary
/// attention, 8 x 384, codes 512 x 512), or "momask-SIZE": MoMask's design with
/// about as many weights as preset SIZE (tiny, small, base). Throws Error for
/// another name.
ModelConfig model_preset(const std::string& preset);

/// All names that model_preset() knows.
const std::vector<std::string>& model_presets();

/// "base" for "momask-base", else the name itself.
std::string preset_size(const std::string& preset);

/// MoMask's design in the sizes of `model`: one row for the whole body with twice
/// the codes, convolutions wide enough for about as many weights, ordinary
/// attention, no retrieval.
void use_one_row(ModelConfig& model);

}  // namespace remomask::training
