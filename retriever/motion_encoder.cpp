#include "retriever/motion_encoder.h"

#include <torch/nn/functional/activation.h>

#include <algorithm>
#include <cmath>

#include "motion/body_parts.h"
#include "nn/layers.h"
#include "remomask/error.h"
#include "retriever/packed_attention.h"

namespace remomask::retriever {

namespace {

constexpr int kMinFrames = 4;
/// Normalised features beyond this many deviations are glitches.
constexpr float kLargestDeviation = 8;
/// Channels that hardly move (m, m/frame, rotation) are not blown up to unit size.
constexpr double kMinDeviation = 2e-3;

/// x [G, M, a] through G linear layers [G, a, b], [G, 1, b].
at::Tensor grouped_linear(const at::Tensor& x, const at::Tensor& weight, const at::Tensor& bias) {
  return torch::baddbmm(bias, x, weight);
}

at::Tensor plain_layer_norm(const at::Tensor& x) { return torch::layer_norm(x, {x.size(2)}); }

at::Tensor initial_weight(int64_t groups, int64_t input, int64_t output) {
  return torch::randn({groups, input, output}) / std::sqrt(static_cast<double>(input));
}

}  // namespace

/// Pre-norm transformer block with weights [encoders, in, out].
class PartBlockImpl : public torch::nn::Module {
 public:
  PartBlockImpl(int64_t encoders, int64_t width, int64_t heads, int64_t hidden)
      : heads_(heads),
        attend_weight_(
            register_parameter("attend_weight", initial_weight(encoders, width, 3 * width))),
        attend_bias_(register_parameter("attend_bias", torch::zeros({encoders, 1, 3 * width}))),
        output_weight_(
            register_parameter("output_weight", 0.5 * initial_weight(encoders, width, width))),
        output_bias_(register_parameter("output_bias", torch::zeros({encoders, 1, width}))),
        expand_weight_(
            register_parameter("expand_weight", initial_weight(encoders, width, hidden))),
        expand_bias_(register_parameter("expand_bias", torch::zeros({encoders, 1, hidden}))),
        contract_weight_(
            register_parameter("contract_weight", 0.5 * initial_weight(encoders, hidden, width))),
        contract_bias_(register_parameter("contract_bias", torch::zeros({encoders, 1, width}))) {}

  at::Tensor forward(const at::Tensor& x, const std::vector<int64_t>& offsets) {
    const at::Tensor attended = packed_attention(
        grouped_linear(plain_layer_norm(x), attend_weight_, attend_bias_), offsets, heads_);
    const at::Tensor y = x + grouped_linear(attended, output_weight_, output_bias_);
    const at::Tensor hidden =
        torch::gelu(grouped_linear(plain_layer_norm(y), expand_weight_, expand_bias_));
    return y + grouped_linear(hidden, contract_weight_, contract_bias_);
  }

 private:
  int64_t heads_;
  at::Tensor attend_weight_, attend_bias_, output_weight_, output_bias_;
  at::Tensor expand_weight_, expand_bias_, contract_weight_, contract_bias_;
};

MotionCrop whole_clip(const motion::Features& features) {
  return {&features, 0, features.frames, {}};
}

MotionCrop random_crop(const motion::Features& features, double least_share, double patch_keep,
                       int64_t patch, CounterRandom& random) {
  const double share = random.uniform(least_share, 1.0);
  const int frames = std::clamp(static_cast<int>(std::lround(share * features.frames)),
                                std::min(kMinFrames, features.frames), features.frames);
  MotionCrop crop{&features, 0, frames, {}};
  crop.first = static_cast<int>(random.below(static_cast<size_t>(features.frames - frames) + 1));
  const int64_t patches = (frames + patch - 1) / patch;
  const size_t fallback = random.below(static_cast<size_t>(patches));
  for (int64_t i = 0; i < patches; ++i) {
    if (random.uniform() < patch_keep) crop.kept.push_back(i);
  }
  if (crop.kept.empty()) crop.kept.push_back(static_cast<int64_t>(fallback));
  return crop;
}

MotionEncoder::MotionEncoder(const RetrieverConfig& config) : config_(config) {
  const Skeleton& skeleton = skeleton_named(config.skeleton);
  if (config.width % config.heads != 0 || config.width % 2 != 0) {
    throw Error("the retriever's width must be even and a multiple of its heads");
  }
  if (config.encoders != 1 && config.encoders != motion::kBodyParts) {
    throw Error("the retriever's encoders must be 1 or 6");
  }
  columns_.resize(static_cast<size_t>(config.encoders));
  for (int part = 0; part < motion::kBodyParts; ++part) {
    auto& columns = columns_[static_cast<size_t>(part) % columns_.size()];
    const std::vector<int> more = motion::part_columns(skeleton, part);
    columns.insert(columns.end(), more.begin(), more.end());
    widest_ = std::max(widest_, static_cast<int64_t>(columns.size()));
  }
  const int64_t width = config.width, encoders = config.encoders;
  mean_ = register_buffer("mean", torch::zeros({skeleton.feature_dim()}));
  inverse_deviation_ = register_buffer("inverse_deviation", torch::ones({skeleton.feature_dim()}));
  // The last input is 1 for a start token alone: its weights are that token.
  at::Tensor embedding = initial_weight(encoders, config.patch * widest_ + 1, width);
  embedding.slice(1, config.patch * widest_).normal_(0, 0.5);
  embed_weight_ = register_parameter("embed_weight", embedding);
  embed_bias_ = register_parameter("embed_bias", torch::zeros({encoders, 1, width}));
  positions_ = nn::sinusoidal_positions(1024, width);
  for (int64_t i = 0; i < config.layers; ++i) {
    blocks_.push_back(register_module(
        "block" + std::to_string(i),
        std::make_shared<PartBlockImpl>(encoders, width, config.heads, config.hidden)));
  }
  head_ = register_module(
      "head", std::make_shared<ProjectionHead>(encoders * width, config.embedding, config.dropout));
  part_weight_ = register_parameter(
      "part_weight", initial_weight(motion::kBodyParts, width, config.part_embedding));
  part_bias_ =
      register_parameter("part_bias", torch::zeros({motion::kBodyParts, 1, config.part_embedding}));
}

void MotionEncoder::set_statistics(const std::vector<const motion::Features*>& train) {
  const auto columns = static_cast<size_t>(mean_.size(0));
  std::vector<double> sum(columns), squares(columns);
  double count = 0;
  for (const motion::Features* clip : train) {
    for (int t = 0; t < clip->frames; ++t) {
      const float* row = clip->row(t);
      for (size_t c = 0; c < columns; ++c) {
        sum[c] += row[c];
        squares[c] += static_cast<double>(row[c]) * row[c];
      }
    }
    count += clip->frames;
  }
  if (count == 0) throw Error("there are no motions to train the retriever on");
  at::NoGradGuard no_grad;
  for (size_t c = 0; c < columns; ++c) {
    const double mean = sum[c] / count;
    const double deviation = std::sqrt(std::max(0.0, squares[c] / count - mean * mean));
    mean_.data_ptr<float>()[c] = static_cast<float>(mean);
    inverse_deviation_.data_ptr<float>()[c] =
        static_cast<float>(1 / std::max(deviation, kMinDeviation));
  }
}

PatchBatch MotionEncoder::patches(const std::vector<MotionCrop>& crops) const {
  const int64_t dimension = mean_.size(0), patch = config_.patch;
  PatchBatch batch;
  batch.offsets.push_back(0);
  std::vector<int64_t> positions;
  for (const MotionCrop& crop : crops) {
    if (crop.features->dim != dimension) {
      throw Error("a motion has " + std::to_string(crop.features->dim) +
                  " feature columns, the retriever wants " + std::to_string(dimension) +
                  "; use motions of the skeleton that it was trained on");
    }
    if (crop.frames < kMinFrames) {
      throw Error("a motion of " + std::to_string(crop.frames) +
                  " frames is too short for the retriever; it needs at least 4");
    }
    const int64_t count = (crop.frames + patch - 1) / patch;
    positions.push_back(0);
    if (crop.kept.empty()) {
      for (int64_t i = 0; i < count; ++i) positions.push_back(1 + i);
    } else {
      for (const int64_t i : crop.kept) positions.push_back(1 + i);
    }
    batch.offsets.push_back(static_cast<int64_t>(positions.size()));
  }
  const auto total = static_cast<int64_t>(positions.size());
  batch.positions = torch::tensor(positions, torch::kLong);
  if (*std::max_element(positions.begin(), positions.end()) >= positions_.size(0)) {
    throw Error("a motion is too long for the retriever; cut it to " +
                std::to_string(patch * positions_.size(0)) + " frames");
  }
  const int64_t inputs = patch * widest_ + 1;
  batch.patches = torch::zeros({config_.encoders, total, inputs});
  float* values = batch.patches.data_ptr<float>();
  const auto place = [&](size_t part, int64_t row) {
    return values + (static_cast<int64_t>(part) * total + row) * inputs;
  };
  std::vector<float> normal(static_cast<size_t>(dimension));
  for (size_t b = 0; b < crops.size(); ++b) {
    const MotionCrop& crop = crops[b];
    for (size_t part = 0; part < columns_.size(); ++part) {
      place(part, batch.offsets[b])[inputs - 1] = 1;
    }
    for (int64_t row = batch.offsets[b] + 1; row < batch.offsets[b + 1]; ++row) {
      for (int64_t k = 0; k < patch; ++k) {
        const int64_t t = std::min<int64_t>((positions[static_cast<size_t>(row)] - 1) * patch + k,
                                            crop.frames - 1);
        normalise_row(crop.features->row(crop.first + static_cast<int>(t)), normal);
        for (size_t part = 0; part < columns_.size(); ++part) {
          float* target = place(part, row) + k * widest_;
          for (const int column : columns_[part]) *target++ = normal[static_cast<size_t>(column)];
        }
      }
    }
  }
  return batch;
}

void MotionEncoder::normalise_row(const float* row, std::vector<float>& normal) const {
  const float *mean = mean_.data_ptr<float>(), *scale = inverse_deviation_.data_ptr<float>();
  for (size_t c = 0; c < normal.size(); ++c) {
    if (!std::isfinite(row[c])) {
      throw Error("a motion has values that are not finite; import it again");
    }
    normal[c] = std::clamp((row[c] - mean[c]) * scale[c], -kLargestDeviation, kLargestDeviation);
  }
}

at::Tensor MotionEncoder::embed(const PatchBatch& batch) const {
  return grouped_linear(batch.patches, embed_weight_, embed_bias_) +
         positions_.index_select(0, batch.positions);
}

MotionVectors MotionEncoder::forward(const PatchBatch& batch) {
  at::Tensor x = embed(batch);
  for (auto& block : blocks_) x = block->forward(x, batch.offsets);
  const std::vector<int64_t> first(batch.offsets.begin(), batch.offsets.end() - 1);
  const at::Tensor starts = plain_layer_norm(x.index_select(1, torch::tensor(first, torch::kLong)));
  MotionVectors vectors;
  vectors.global = head_->forward(starts.transpose(0, 1).flatten(1));
  // A single encoder's state goes through the heads of all parts.
  const at::Tensor of_parts = starts.expand({motion::kBodyParts, -1, -1});
  vectors.parts = unit_rows(grouped_linear(of_parts, part_weight_, part_bias_).transpose(0, 1));
  return vectors;
}

std::vector<at::Tensor> MotionEncoder::block_states(const PatchBatch& batch) {
  std::vector<at::Tensor> states = {embed(batch)};
  for (auto& block : blocks_) {
    states.push_back(block->forward(states.back(), batch.offsets));
  }
  return states;
}

}  // namespace remomask::retriever
