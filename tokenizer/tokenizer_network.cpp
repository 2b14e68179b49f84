#include "tokenizer/tokenizer_network.h"

#include <algorithm>

#include "base/time.h"
#include "remomask/error.h"

namespace remomask::tokenizer {

namespace {

int64_t patch_frames(const TokenizerConfig& config) {
  return kFramesPerToken >> (config.widths.size() - 1);
}

// Number of weight sets as RowLinear takes it.
int64_t weight_rows(const TokenizerConfig& config) {
  return config.per_row_weights && config.rows > 1 ? config.rows : 0;
}

int64_t row_channels(const TokenizerConfig& config, const Skeleton& skeleton) {
  return config.rows == 1 ? skeleton.feature_dim() : motion::kPartSlots * kSlotChannels;
}

QuantizerOptions quantizer_options(const TokenizerConfig& config) {
  return {config.levels, config.codes, config.code_width,
          config.per_row_codebooks ? config.rows : 1};
}

bool wants_mixer(const TokenizerConfig& config) {
  return config.rows > 1 && config.mixer_width > 0;
}

}  // namespace

void check_tokenizer_config(const TokenizerConfig& config) {
  const auto refuse = [](const std::string& why) { throw Error("tokenizer config: " + why); };
  if (config.rows != 1 && config.rows != motion::kBodyParts) refuse("rows must be 1 or 6");
  if (config.widths.empty() || config.widths.size() > 3) refuse("widths needs 1 to 3 numbers");
  if (config.blocks.size() != config.widths.size())
    refuse("blocks needs as many numbers as widths");
  for (const int64_t width : config.widths) {
    if (width < 1) refuse("every width must be positive");
  }
  for (const int64_t blocks : config.blocks) {
    if (blocks < 0) refuse("no number of blocks may be negative");
  }
  if (config.levels < 1 || config.codes < 2 || config.code_width < 1) {
    refuse("levels and code_width must be at least 1, codes at least 2");
  }
  if (config.dilation_growth < 1) refuse("dilation_growth must be at least 1");
  if (config.dropout < 0 || config.dropout >= 1) refuse("dropout must be in [0, 1)");
}

TokenizerEncoderImpl::TokenizerEncoderImpl(const TokenizerConfig& config, int64_t channels)
    : patch_(patch_frames(config)) {
  const int64_t rows = weight_rows(config);
  const auto& widths = config.widths;
  if (patch_ > 1) {
    patch_layer_ = register_module("patch", RowLinear(rows, patch_ * channels, widths[0]));
  } else {
    first_ = register_module("first", TimeConv(rows, channels, widths[0], 3, 1, 1, 1));
  }
  for (size_t i = 0; i < widths.size(); ++i) {
    const std::string number = std::to_string(i);
    if (i > 0) {
      down_.push_back(
          register_module("down" + number, TimeConv(rows, widths[i - 1], widths[i], 4, 2, 1, 1)));
    }
    stacks_.push_back(register_module(
        "stack" + number,
        RowBlockStack(rows, widths[i], config.blocks[i], config.dilation_growth, config.dropout)));
  }
  if (wants_mixer(config)) {
    mixer_ = register_module("mixer", RowMixer(config.rows, widths.back(), config.mixer_width));
  }
  last_ = register_module("last", TimeConv(rows, widths.back(), config.code_width, 3, 1, 1, 1));
}

at::Tensor TokenizerEncoderImpl::forward(const at::Tensor& x) {
  at::Tensor h;
  if (patch_ > 1) {
    h = patch_layer_(x.reshape({x.size(0), x.size(1), x.size(2) / patch_, patch_ * x.size(3)}));
  } else {
    h = torch::relu(first_(x));
  }
  for (size_t i = 0; i < stacks_.size(); ++i) {
    if (i > 0) h = down_[i - 1](h);
    h = stacks_[i](h);
  }
  if (mixer_) h = mixer_(h);
  return last_(h);
}

TokenizerDecoderImpl::TokenizerDecoderImpl(const TokenizerConfig& config, int64_t channels)
    : patch_(patch_frames(config)) {
  const int64_t rows = weight_rows(config);
  const auto& widths = config.widths;
  first_ = register_module("first", TimeConv(rows, config.code_width, widths.back(), 3, 1, 1, 1));
  if (wants_mixer(config)) {
    mixer_ = register_module("mixer", RowMixer(config.rows, widths.back(), config.mixer_width));
  }
  for (size_t i = widths.size(); i-- > 0;) {
    const std::string number = std::to_string(i);
    stacks_.push_back(register_module(
        "stack" + number,
        RowBlockStack(rows, widths[i], config.blocks[i], config.dilation_growth, config.dropout)));
    if (i > 0) {
      up_.push_back(
          register_module("up" + number, TimeConv(rows, widths[i], widths[i - 1], 3, 1, 1, 1)));
    }
  }
  if (patch_ > 1) {
    patch_layer_ = register_module("patch", RowLinear(rows, widths[0], patch_ * channels));
    if (config.smooth_width > 0) {
      smooth_in_ =
          register_module("smooth_in", TimeConv(rows, channels, config.smooth_width, 3, 1, 1, 1));
      smooth_out_ =
          register_module("smooth_out", TimeConv(rows, config.smooth_width, channels, 3, 1, 1, 1));
    }
  } else {
    last_ = register_module("last", TimeConv(rows, widths[0], widths[0], 3, 1, 1, 1));
    output_ = register_module("output", TimeConv(rows, widths[0], channels, 3, 1, 1, 1));
  }
}

at::Tensor TokenizerDecoderImpl::forward(const at::Tensor& z) {
  auto h = torch::relu(first_(z));
  if (mixer_) h = mixer_(h);
  for (size_t i = 0; i < stacks_.size(); ++i) {
    h = stacks_[i](h);
    if (i < up_.size()) h = up_[i](h.repeat_interleave(2, 2));
  }
  if (patch_ == 1) return output_(torch::relu(last_(h)));
  h = patch_layer_(h);
  h = h.view({h.size(0), h.size(1), h.size(2) * patch_, h.size(3) / patch_});
  // Patches meet without overlap: these convolutions join their seams.
  if (smooth_in_) h = h + smooth_out_(torch::relu(smooth_in_(h)));
  return h;
}

TokenizerNetworkImpl::TokenizerNetworkImpl(const TokenizerConfig& config)
    : config_((check_tokenizer_config(config), config)),
      skeleton_(skeleton_named(config.skeleton)),
      part_map_(skeleton_),
      encoder_(
          register_module("encoder", TokenizerEncoder(config, row_channels(config, skeleton_)))),
      quantizer_(register_module("quantizer", ResidualQuantizer(quantizer_options(config)))),
      decoder_(
          register_module("decoder", TokenizerDecoder(config, row_channels(config, skeleton_)))),
      mean_(register_buffer("mean", torch::zeros({skeleton_.feature_dim()}))),
      deviation_(register_buffer("deviation", torch::ones({skeleton_.feature_dim()}))) {}

at::Tensor TokenizerNetworkImpl::encode(const at::Tensor& normalised) {
  const int64_t batch = normalised.size(0), frames = normalised.size(1);
  TORCH_CHECK(frames % kFramesPerToken == 0, "frames must be a multiple of 4");
  at::Tensor rows =
      config_.rows == 1
          ? normalised.unsqueeze(0)
          : part_map_.to_map(normalised)
                .view({batch, frames, config_.rows, motion::kPartSlots * kSlotChannels})
                .permute({2, 0, 1, 3});
  const auto z = encoder_(rows);
  return z.reshape({quantizer_->options().groups, -1, config_.code_width});
}

at::Tensor TokenizerNetworkImpl::decode(const at::Tensor& latents, int64_t batch) {
  const auto rows = decoder_(latents.reshape({config_.rows, batch, -1, config_.code_width}));
  if (config_.rows == 1) return rows.squeeze(0);
  return part_map_.to_features(
      rows.permute({1, 2, 0, 3}).reshape({batch, rows.size(2), kSlots, kSlotChannels}));
}

TokenizerOutput TokenizerNetworkImpl::train_step(const at::Tensor& normalised,
                                                 const CodebookTraining& training, uint64_t seed,
                                                 int64_t step) {
  TokenizerOutput output;
  output.quantized = quantizer_->train_step(encode(normalised), training, seed, step);
  output.features = decode(output.quantized.value, normalised.size(0));
  return output;
}

at::Tensor TokenizerNetworkImpl::tokens(const at::Tensor& normalised) {
  return quantizer_->encode(encode(normalised))
      .view({config_.rows, normalised.size(0), -1, config_.levels})
      .permute({1, 2, 0, 3})
      .contiguous();
}

at::Tensor TokenizerNetworkImpl::from_tokens(const at::Tensor& tokens) {
  const auto index =
      tokens.permute({2, 0, 1, 3}).reshape({quantizer_->options().groups, -1, tokens.size(3)});
  return decode(quantizer_->decode(index), tokens.size(0));
}

void TokenizerNetworkImpl::set_statistics(const at::Tensor& mean, const at::Tensor& deviation) {
  at::NoGradGuard no_grad;
  mean_.copy_(mean);
  deviation_.copy_(deviation);
}

at::Tensor TokenizerNetworkImpl::normalise(const at::Tensor& features) const {
  return (features - mean_) / deviation_;
}

at::Tensor TokenizerNetworkImpl::denormalise(const at::Tensor& normalised) const {
  return normalised * deviation_ + mean_;
}

}  // namespace remomask::tokenizer
