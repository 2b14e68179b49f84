#pragma once

#include <string>

#include "generator/masked_transformer.h"
#include "generator/residual_transformer.h"
#include "generator/tokenizer.h"
#include "retriever/config.h"

namespace remomask {

/// Sizes of all networks of one model.
struct ModelConfig {
  TokenizerConfig tokenizer;
  RetrieverConfig retriever;
  MaskedConfig masked;
  ResidualConfig residual;
};

/// "tiny" (tests), "base" (default, trained in an hour on a few CPU cores),
/// "paper" (sizes of ReMoMask: masked 6 x 512, residual 6 x 384, codes 256 x
/// 1024) or "momask" (one row, no retrieval, 8 x 384, codes 512 x 512). Throws
/// Error for another name.
ModelConfig model_preset(const std::string& preset);

}  // namespace remomask
