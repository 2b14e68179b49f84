#include "evaluation/evaluator_network.h"

#include <torch/nn/functional/embedding.h>
#include <torch/nn/init.h>
#include <torch/nn/modules/activation.h>
#include <torch/nn/modules/dropout.h>
#include <torch/nn/modules/normalization.h>
#include <torch/nn/utils/rnn.h>
#include <torch/utils.h>

#include <algorithm>
#include <cmath>

#include "evaluation/word_classes.h"
#include "remomask/error.h"

namespace remomask::evaluation {

namespace {

constexpr double kSlope = 0.2, kMovementDropout = 0.2;
/// Columns that hardly move are not blown up to unit size.
constexpr double kMinSpread = 1e-4;

torch::nn::LeakyReLU leaky() {
  return torch::nn::LeakyReLU(torch::nn::LeakyReLUOptions().negative_slope(kSlope));
}

torch::nn::Conv1d halving(int64_t input, int64_t output) {
  return torch::nn::Conv1d(torch::nn::Conv1dOptions(input, output, 4).stride(2).padding(1));
}

torch::nn::ConvTranspose1d doubling(int64_t input, int64_t output) {
  return torch::nn::ConvTranspose1d(
      torch::nn::ConvTranspose1dOptions(input, output, 4).stride(2).padding(1));
}

/// Xavier-normal weights and zero biases of all linear layers and convolutions;
/// recurrent layers keep torch's own.
void initialise_evaluator(torch::nn::Module& module) {
  at::NoGradGuard no_grad;
  const auto set = [](auto* layer) {
    if (layer == nullptr) return;
    torch::nn::init::xavier_normal_(layer->weight);
    torch::nn::init::zeros_(layer->bias);
  };
  for (const auto& part : module.modules(/*include_self=*/false)) {
    set(part->as<torch::nn::Linear>());
    set(part->as<torch::nn::Conv1d>());
    set(part->as<torch::nn::ConvTranspose1d>());
  }
}

}  // namespace

MovementEncoderImpl::MovementEncoderImpl(int64_t columns, int64_t width)
    : main_(halving(columns, width), torch::nn::Dropout(kMovementDropout), leaky(),
            halving(width, width), torch::nn::Dropout(kMovementDropout), leaky()),
      out_net_(width, width) {
  register_module("main", main_);
  register_module("out_net", out_net_);
  initialise_evaluator(*this);
}

at::Tensor MovementEncoderImpl::forward(const at::Tensor& motion) {
  return out_net_(main_->forward(motion.transpose(1, 2)).transpose(1, 2));
}

MovementDecoderImpl::MovementDecoderImpl(int64_t width, int64_t columns)
    : main_(doubling(width, width), leaky(), doubling(width, columns), leaky()),
      out_net_(columns, columns) {
  register_module("main", main_);
  register_module("out_net", out_net_);
  initialise_evaluator(*this);
}

at::Tensor MovementDecoderImpl::forward(const at::Tensor& movements) {
  return out_net_(main_->forward(movements.transpose(1, 2)).transpose(1, 2));
}

GruHeadImpl::GruHeadImpl(int64_t input, int64_t hidden, int64_t output, int64_t classes)
    : hidden_(register_parameter("hidden", torch::randn({2, 1, hidden}))),
      input_emb_(input, hidden),
      gru_(torch::nn::GRUOptions(hidden, hidden).batch_first(true).bidirectional(true)),
      output_net_(torch::nn::Linear(2 * hidden, hidden),
                  torch::nn::LayerNorm(torch::nn::LayerNormOptions({hidden})), leaky(),
                  torch::nn::Linear(hidden, output)) {
  if (classes > 0) pos_emb_ = register_module("pos_emb", torch::nn::Linear(classes, input));
  register_module("input_emb", input_emb_);
  register_module("gru", gru_);
  register_module("output_net", output_net_);
  initialise_evaluator(*this);
}

at::Tensor GruHeadImpl::forward(const at::Tensor& sequence, const at::Tensor& lengths) {
  const auto packed = torch::nn::utils::rnn::pack_padded_sequence(
      input_emb_(sequence), lengths, /*batch_first=*/true, /*enforce_sorted=*/false);
  const at::Tensor first = hidden_.repeat({1, sequence.size(0), 1});
  const at::Tensor last = std::get<1>(gru_->forward_with_packed_input(packed, first));
  return output_net_->forward(torch::cat({last[0], last[1]}, 1));
}

at::Tensor GruHeadImpl::embed_classes(const at::Tensor& classes) {
  return torch::nn::functional::embedding(classes, pos_emb_->weight.t()) + pos_emb_->bias;
}

EvaluatorNetworkImpl::EvaluatorNetworkImpl(const EvaluatorConfig& config)
    : config_(config),
      words_(config.vocabulary, config.max_words),
      mean_(register_buffer("mean", torch::zeros({skeleton_named(config.skeleton).feature_dim()}))),
      deviation_(register_buffer("deviation", torch::ones({mean_.size(0)}))),
      movement_encoder_(mean_.size(0) - kContactColumns, config.movement_width),
      motion_encoder_(config.movement_width, config.motion_hidden, config.embedding, 0),
      text_encoder_(config.word_width, config.text_hidden, config.embedding, kWordClasses),
      word_embedding_(words_.size(), config.word_width) {
  register_module("movement_encoder", movement_encoder_);
  register_module("motion_encoder", motion_encoder_);
  register_module("text_encoder", text_encoder_);
  register_module("word_embedding", word_embedding_);
}

at::Tensor EvaluatorNetworkImpl::embed_text(const WordBatch& words) {
  return text_encoder_(word_embedding_(words.ids) + text_encoder_->embed_classes(words.classes),
                       words.lengths);
}

at::Tensor EvaluatorNetworkImpl::embed_motion(const MovementBatch& motions) {
  const at::Tensor read = motions.features.narrow(2, 0, columns() - kContactColumns);
  return motion_encoder_(movement_encoder_(read), motions.lengths);
}

MovementBatch EvaluatorNetworkImpl::batch(const std::vector<EvaluatorCrop>& crops) const {
  std::vector<int64_t> lengths;
  int64_t longest = 0;
  for (const EvaluatorCrop& crop : crops) {
    if (crop.features->dim != columns()) {
      throw Error("a motion has " + std::to_string(crop.features->dim) +
                  " feature columns, the evaluator wants " + std::to_string(columns()) +
                  "; use motions of the skeleton that it was trained on");
    }
    const int64_t frames = std::min<int64_t>(crop.frames, config_.max_frames);
    if (frames < kFramesPerMovement) {
      throw Error("a motion of " + std::to_string(frames) +
                  " frames is too short for the evaluator; it needs at least 4");
    }
    lengths.push_back(frames / kFramesPerMovement);
    longest = std::max(longest, lengths.back());
  }
  // The convolutions reach one token beyond the end: zeros must follow there for
  // every motion but the longest possible, as they do alone.
  const int64_t frames =
      kFramesPerMovement * std::min(longest + 1, config_.max_frames / kFramesPerMovement);
  MovementBatch result{torch::zeros({static_cast<int64_t>(crops.size()), frames, columns()}),
                       torch::tensor(lengths, torch::kLong)};
  for (size_t i = 0; i < crops.size(); ++i) {
    const int64_t used = lengths[i] * kFramesPerMovement;
    const at::Tensor rows =
        torch::from_blob(const_cast<float*>(crops[i].features->row(crops[i].first)),
                         {used, columns()}, torch::kFloat);
    result.features[static_cast<int64_t>(i)].narrow(0, 0, used).copy_((rows - mean_) / deviation_);
  }
  return result;
}

void EvaluatorNetworkImpl::set_statistics(const std::vector<const motion::Features*>& train) {
  at::NoGradGuard no_grad;
  at::Tensor sum = torch::zeros({columns()}, torch::kDouble), squares = sum.clone();
  int64_t count = 0;
  for (const motion::Features* clip : train) {
    if (clip->dim != columns()) throw Error("a motion has another skeleton than the evaluator");
    const at::Tensor rows = torch::from_blob(const_cast<float*>(clip->values.data()),
                                             {clip->frames, columns()}, torch::kFloat)
                                .to(torch::kDouble);
    sum += rows.sum(0);
    squares += rows.square().sum(0);
    count += clip->frames;
  }
  if (count == 0) throw Error("there are no motions to train the evaluator on");
  const double frames = static_cast<double>(count);
  const at::Tensor mean = sum / frames;
  at::Tensor deviation = (squares / frames - mean.square()).clamp_min(0).sqrt();
  const int64_t joints = skeleton_named(config_.skeleton).joints();
  const int64_t positions = 4, rotations = positions + 3 * (joints - 1),
                velocities = rotations + 6 * (joints - 1), contacts = velocities + 3 * joints;
  const std::vector<int64_t> edges = {0,         1,          3,        positions,
                                      rotations, velocities, contacts, columns()};
  for (size_t group = 0; group + 1 < edges.size(); ++group) {
    const bool weighted = edges[group] < positions || edges[group] == contacts;
    at::Tensor part = deviation.slice(0, edges[group], edges[group + 1]);
    part.fill_(std::max(part.mean().item<double>(), kMinSpread) /
               (weighted ? config_.root_weight : 1.0));
  }
  mean_.copy_(mean);
  deviation_.copy_(deviation);
}

}  // namespace remomask::evaluation
