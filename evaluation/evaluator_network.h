#pragma once

#include <torch/nn/module.h>
#include <torch/nn/modules/container/sequential.h>
#include <torch/nn/modules/conv.h>
#include <torch/nn/modules/embedding.h>
#include <torch/nn/modules/linear.h>
#include <torch/nn/modules/rnn.h>

#include <vector>

#include "evaluation/evaluator_config.h"
#include "evaluation/evaluator_words.h"

namespace remomask::evaluation {

/// Frames behind one movement token.
inline constexpr int64_t kFramesPerMovement = 4;
/// Contacts are not read: they are the last columns of the features.
inline constexpr int64_t kContactColumns = 4;

/// Two convolutions that halve time, dropout 0.2, LeakyReLU 0.2, one linear layer.
class MovementEncoderImpl : public torch::nn::Module {
 public:
  MovementEncoderImpl(int64_t columns, int64_t width);
  /// Normalised features without contacts [B, 4 n, C] -> [B, n, W].
  at::Tensor forward(const at::Tensor& motion);

 private:
  torch::nn::Sequential main_;
  torch::nn::Linear out_net_;
};
TORCH_MODULE(MovementEncoder);

/// The movement encoder backwards, to all columns of the features.
class MovementDecoderImpl : public torch::nn::Module {
 public:
  MovementDecoderImpl(int64_t width, int64_t columns);
  /// [B, n, W] -> [B, 4 n, D].
  at::Tensor forward(const at::Tensor& movements);

 private:
  torch::nn::Sequential main_;
  torch::nn::Linear out_net_;
};
TORCH_MODULE(MovementDecoder);

/// Bidirectional GRU with a learnt first state; its two last states through
/// Linear, LayerNorm, LeakyReLU 0.2, Linear.
class GruHeadImpl : public torch::nn::Module {
 public:
  /// `classes` > 0: has the embedding "pos_emb" of word classes.
  GruHeadImpl(int64_t input, int64_t hidden, int64_t output, int64_t classes);
  /// [B, L, input], int64 lengths [B] of at least 1 -> [B, output].
  at::Tensor forward(const at::Tensor& sequence, const at::Tensor& lengths);
  /// Class embeddings [B, L, input] of int64 [B, L].
  at::Tensor embed_classes(const at::Tensor& classes);

 private:
  at::Tensor hidden_;
  torch::nn::Linear pos_emb_ = nullptr, input_emb_;
  torch::nn::GRU gru_;
  torch::nn::Sequential output_net_;
};
TORCH_MODULE(GruHead);

/// Motions as the evaluator reads them.
struct MovementBatch {
  at::Tensor features;  ///< normalised [B, 4 n, D], zeros behind the end of a motion
  at::Tensor lengths;   ///< int64 [B], movement tokens
};

/// Part of a motion; its features must outlive it.
struct EvaluatorCrop {
  const motion::Features* features = nullptr;
  int first = 0, frames = 0;
};

/// Movement encoder, motion encoder and text encoder in one space, with names
/// and shapes of the public checkpoint of Guo et al. (movement_encoder.main.0,
/// motion_encoder.gru, text_encoder.pos_emb ...) beside our own word embedding
/// and the statistics of the features.
class EvaluatorNetworkImpl : public torch::nn::Module {
 public:
  explicit EvaluatorNetworkImpl(const EvaluatorConfig& config);

  /// [B, E].
  at::Tensor embed_text(const WordBatch& words);
  at::Tensor embed_motion(const MovementBatch& motions);

  /// Lengths are cut to a multiple of 4 and to max_frames. The result for a
  /// motion does not depend on the others of its batch. Throws Error for other
  /// columns or fewer than 4 frames.
  MovementBatch batch(const std::vector<EvaluatorCrop>& crops) const;

  /// Mean and deviation of each column over all frames; deviations are averaged
  /// over the groups of columns of HumanML3D, those of root velocity, height and
  /// contacts divided by root_weight.
  void set_statistics(const std::vector<const motion::Features*>& train);

  MovementEncoder& movement_encoder() { return movement_encoder_; }
  const EvaluatorConfig& config() const { return config_; }
  const EvaluatorWords& words() const { return words_; }
  int64_t columns() const { return mean_.size(0); }

 private:
  EvaluatorConfig config_;
  EvaluatorWords words_;
  at::Tensor mean_, deviation_;
  MovementEncoder movement_encoder_;
  GruHead motion_encoder_, text_encoder_;
  torch::nn::Embedding word_embedding_;
};
TORCH_MODULE(EvaluatorNetwork);

}  // namespace remomask::evaluation
