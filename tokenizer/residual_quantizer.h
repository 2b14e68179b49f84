#pragma once

#include <torch/nn/module.h>

#include <cstdint>
#include <vector>

namespace remomask::tokenizer {

struct QuantizerOptions {
  int64_t levels = 6;
  int64_t codes = 256;
  int64_t width = 64;
  int64_t groups = 6;  ///< independent sets of codebooks, one a row; 1: shared by all rows
};

/// How the codebooks learn; not part of the network's identity.
struct CodebookTraining {
  double decay = 0.99;            ///< mu of the moving averages
  int64_t reset_every = 25;       ///< steps between searches for dead codes; 0: never
  double dead_share = 0.1;        ///< a code is dead below this share of the mean use
  double level_dropout = 0.2;     ///< chance that only the first s levels, s uniform, are used
  double sample_temperature = 0;  ///< stochastic assignment: temperature in units of the mean
                                  ///< squared distance to the nearest code; 0: nearest code
};

/// What one training step of the quantiser gives.
struct Quantized {
  at::Tensor value;       ///< [G, N, C] sum of the codes, gradient passed straight through once
  at::Tensor commitment;  ///< scalar: mean over active levels of mse(residual, stopgrad(code))
  std::vector<double> perplexity;  ///< of each active level, mean over groups
};

/// Residual vector quantiser (MoMask eq. 1-3): level l codes what the levels
/// before it left over. Codebooks are moving averages (van den Oord et al.
/// 2017, appendix A.1), not trained by gradient; their whole state, with the
/// flag that they were initialised, consists of buffers and is saved.
class ResidualQuantizerImpl : public torch::nn::Module {
 public:
  explicit ResidualQuantizerImpl(const QuantizerOptions& options);

  /// z [G, N, C], every position real. Quantises and updates the codebooks; the
  /// first call takes rows of z as codes. Randomness comes from (seed, step).
  Quantized train_step(const at::Tensor& z, const CodebookTraining& training, uint64_t seed,
                       int64_t step);

  /// Nearest codes: [G, N, C] -> int64 [G, N, levels].
  at::Tensor encode(const at::Tensor& z) const;
  /// Sum of codes: [G, N, q] with 1 <= q <= levels -> [G, N, C].
  at::Tensor decode(const at::Tensor& indices) const;

  const QuantizerOptions& options() const { return options_; }
  bool initialised() const;
  at::Tensor codebook(int64_t level) const { return codebook_[level]; }  ///< [G, K, C]
  at::Tensor counts(int64_t level) const { return count_[level]; }       ///< [G, K]
  at::Tensor sums(int64_t level) const { return sum_[level]; }           ///< [G, K, C]
  /// Sets a level to given codes [G, K, C], each with weight 1.
  void set_codebook(int64_t level, const at::Tensor& codes);

 private:
  at::Tensor assign(const at::Tensor& residual, int64_t level, double temperature) const;
  at::Tensor look_up(const at::Tensor& index, int64_t level) const;
  void initialise_level(int64_t level, const at::Tensor& residual, uint64_t seed);
  double update_level(int64_t level, const at::Tensor& residual, const at::Tensor& index,
                      double decay);
  void reset_dead_codes(int64_t level, const at::Tensor& residual, double dead_share,
                        uint64_t seed);
  at::Tensor random_rows(const at::Tensor& residual, uint64_t seed) const;

  QuantizerOptions options_;
  at::Tensor codebook_, sum_, count_, initialised_;  ///< buffers
};
TORCH_MODULE(ResidualQuantizer);

}  // namespace remomask::tokenizer
