#include "tokenizer/tokenizer.h"

#include <torch/types.h>

#include "base/time.h"
#include "remomask/error.h"
#include "tokenizer/length_batches.h"
#include "tokenizer/tokenizer_network.h"

namespace remomask::tokenizer {

namespace {

constexpr size_t kEncodeBatch = 32;

TokenizerConfig tokenizer_config(const nn::ModelStage& stage) {
  if (stage.kind != "tokenizer") {
    throw Error("this model stage is \"" + stage.kind + "\", not a tokenizer");
  }
  try {
    return stage.config.get<TokenizerConfig>();
  } catch (const nlohmann::json::exception& problem) {
    throw Error(std::string("the config of the tokenizer cannot be read: ") + problem.what());
  }
}

motion::Features to_features(const at::Tensor& rows) {
  const auto values = rows.to(torch::kFloat).contiguous();
  motion::Features features(static_cast<int>(values.size(0)), static_cast<int>(values.size(1)));
  std::copy_n(values.data_ptr<float>(), values.numel(), features.values.begin());
  return features;
}

}  // namespace

struct Tokenizer::Impl {
  mutable TokenizerNetwork network;
  std::string hash;

  explicit Impl(const nn::ModelStage& stage)
      : network(load_tokenizer_network(stage)), hash(nn::stage_hash(stage)) {}
};

TokenizerNetwork load_tokenizer_network(const nn::ModelStage& stage) {
  TokenizerNetwork network(tokenizer_config(stage));
  nn::load_module_tensors(*network, stage.tensors, "tokenizer");
  network->eval();
  return network;
}

Tokenizer::Tokenizer(const nn::ModelStage& stage) : impl_(std::make_unique<Impl>(stage)) {}
Tokenizer::~Tokenizer() = default;
Tokenizer::Tokenizer(Tokenizer&&) noexcept = default;
Tokenizer& Tokenizer::operator=(Tokenizer&&) noexcept = default;

const TokenizerConfig& Tokenizer::config() const { return impl_->network->config(); }
const std::string& Tokenizer::hash() const { return impl_->hash; }

at::Tensor Tokenizer::encode(const motion::Features& features) const {
  return encode(std::vector<const motion::Features*>{&features})[0];
}

std::vector<at::Tensor> Tokenizer::encode(const std::vector<const motion::Features*>& clips) const {
  at::NoGradGuard no_grad;
  const int64_t dim = impl_->network->skeleton().feature_dim();
  for (const motion::Features* clip : clips) {
    if (clip->dim != dim) {
      throw Error("cannot tokenize features of " + std::to_string(clip->dim) +
                  " columns: this tokenizer is for " + std::to_string(dim));
    }
    if (clip->frames < kFramesPerToken) {
      throw Error("cannot tokenize a motion of " + std::to_string(clip->frames) +
                  " frames: it needs at least 4");
    }
  }
  std::vector<at::Tensor> tokens(clips.size());
  for (const LengthBatch& batch : batches_by_length(clips, kFramesPerToken, kEncodeBatch)) {
    const auto found = impl_->network->tokens(impl_->network->normalise(stack_batch(clips, batch)));
    for (size_t i = 0; i < batch.members.size(); ++i) {
      tokens[batch.members[i]] = found[static_cast<int64_t>(i)].clone();
    }
  }
  return tokens;
}

motion::Features Tokenizer::decode(const at::Tensor& tokens) const {
  at::NoGradGuard no_grad;
  const TokenizerConfig& config = impl_->network->config();
  if (tokens.dim() != 3 || tokens.size(0) < 1 || tokens.size(1) != config.rows ||
      tokens.size(2) < 1 || tokens.size(2) > config.levels || tokens.scalar_type() != at::kLong) {
    throw Error("tokens must be int64 [n, " + std::to_string(config.rows) + ", 1.." +
                std::to_string(config.levels) + "]");
  }
  if (tokens.min().item<int64_t>() < 0 || tokens.max().item<int64_t>() >= config.codes) {
    throw Error("tokens must be in 0.." + std::to_string(config.codes - 1));
  }
  const auto normalised = impl_->network->from_tokens(tokens.unsqueeze(0));
  return to_features(impl_->network->denormalise(normalised)[0]);
}

}  // namespace remomask::tokenizer
