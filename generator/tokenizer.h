#pragma once

#include <ATen/core/Tensor.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "motion/features.h"
#include "nn/model_file.h"

namespace remomask {

/// Sizes of the 2D residual VQ-VAE.
struct TokenizerConfig {
  std::string preset = "base";
  std::string skeleton = "humanml3d";
  std::string feature_mode = "fixed";
  int64_t rows = 6;            ///< rows of the token map: six body parts, or 1 (1D, MoMask)
  int64_t levels = 6;          ///< base level + residual levels
  int64_t codes = 256;         ///< entries a codebook
  int64_t code_width = 64;     ///< width of a code
  std::vector<int64_t> widths = {64, 128, 256};  ///< channels at time T, T/2, T/4
  int64_t blocks = 3;          ///< dilated residual blocks a stage (9, 3, 1)
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TokenizerConfig, preset, skeleton, feature_mode, rows, levels,
                                   codes, code_width, widths, blocks)

/// A trained tokenizer for inference: motion features <-> token map. Clips are
/// processed at their true length, so a clip alone and in a batch give the
/// same tokens.
class Tokenizer {
 public:
  /// Throws Error when the stage is no tokenizer or its tensors do not fit.
  explicit Tokenizer(const ModelStage& stage);
  ~Tokenizer();
  Tokenizer(Tokenizer&&) noexcept;
  Tokenizer& operator=(Tokenizer&&) noexcept;

  /// Unnormalised features of T >= 4 rows -> int64 [T/4, rows, levels]; up to
  /// three rows at the end are dropped.
  at::Tensor encode(const Features& features) const;
  /// The same for many clips (grouped by length inside).
  std::vector<at::Tensor> encode(const std::vector<const Features*>& clips) const;
  /// int64 [n, rows, q] with 1 <= q <= levels (missing levels count as zero
  /// vectors) -> unnormalised features of 4 n rows.
  Features decode(const at::Tensor& tokens) const;

  const TokenizerConfig& config() const;
  const std::string& hash() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace remomask
