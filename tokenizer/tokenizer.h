#pragma once

#include <ATen/core/Tensor.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "motion/features.h"
#include "nn/model_file.h"

namespace remomask::tokenizer {

/// Sizes of the 2D residual VQ-VAE. The defaults are the preset `base`.
struct TokenizerConfig {
  std::string preset = "base";
  std::string skeleton = "humanml3d";
  std::string feature_mode = "fixed";
  int64_t rows = 6;         ///< rows of the token map: six body parts, or 1 (1D, MoMask)
  int64_t levels = 6;       ///< base level + residual levels
  int64_t codes = 256;      ///< entries a codebook
  int64_t code_width = 64;  ///< width of a code
  /// Channels at each time scale, at most three. The first scale works on
  /// patches of 4, 2 or 1 frames, every further one halves time, so that the
  /// last is T/4: {w} is one linear patch of 4 frames; {512, 512, 512} are
  /// MoMask's convolutions.
  std::vector<int64_t> widths = {128};
  std::vector<int64_t> blocks = {6};  ///< residual blocks at each time scale
  int64_t dilation_growth = 3;        ///< three neighbouring blocks: growth^2, growth, 1
  int64_t mixer_width = 512;          ///< hidden width of the exchange between rows; 0: none
  int64_t smooth_width = 64;      ///< hidden width of the last convolutions at full rate (patches
                                  ///< of 2 or 4 frames only); 0: none
  double dropout = 0.0;           ///< in residual blocks (MoMask: 0.2)
  bool per_row_weights = true;    ///< every body part has weights of its own
  bool per_row_codebooks = true;  ///< every body part has codebooks of its own
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TokenizerConfig, preset, skeleton, feature_mode, rows, levels,
                                   codes, code_width, widths, blocks, dilation_growth, mixer_width,
                                   smooth_width, dropout, per_row_weights, per_row_codebooks)

/// A trained tokenizer for inference: motion features <-> token map. Clips are
/// processed at their true length, so a clip alone and in a batch give the
/// same tokens.
class Tokenizer {
 public:
  /// Throws Error when the stage is no tokenizer or its tensors do not fit.
  explicit Tokenizer(const nn::ModelStage& stage);
  ~Tokenizer();
  Tokenizer(Tokenizer&&) noexcept;
  Tokenizer& operator=(Tokenizer&&) noexcept;

  /// Unnormalised features of T >= 4 rows -> int64 [T/4, rows, levels]; up to
  /// three rows at the end are dropped.
  at::Tensor encode(const motion::Features& features) const;
  /// The same for many clips (grouped by length inside).
  std::vector<at::Tensor> encode(const std::vector<const motion::Features*>& clips) const;
  /// int64 [n, rows, q] with 1 <= q <= levels (missing levels count as zero
  /// vectors) -> unnormalised features of 4 n rows.
  motion::Features decode(const at::Tensor& tokens) const;

  const TokenizerConfig& config() const;
  const std::string& hash() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace remomask::tokenizer
