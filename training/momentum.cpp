#include "training/momentum.h"

#include <algorithm>
#include <cmath>

#include "motion/body_parts.h"
#include "nn/model_file.h"

namespace remomask::training {

namespace {

constexpr double kLargestScale = 100;  // temperature 0.01, as in CLIP

/// The states of a batch after words (not special tokens or pads) were hidden with probability
/// `share`. Only captions that lose a word are encoded again.
at::Tensor states_with_hidden_words(const PairBatch& batch, double share,
                                    const retriever::RetrieverModel& model) {
  if (share <= 0) return batch.text_states;
  const encoders::TokenBatch& tokens = batch.tokens;
  at::Tensor hidden = torch::rand(tokens.ids.sizes()).lt(share);
  for (const int64_t special : model.text_tower().special_ids()) {
    hidden = hidden.logical_and(tokens.ids.ne(special));
  }
  const at::Tensor rows = torch::nonzero(hidden.any(1)).squeeze(1);
  if (rows.numel() == 0) return batch.text_states;
  const at::Tensor ids = tokens.ids.masked_fill(hidden, model.text_tower().mask_id());
  return batch.text_states.index_copy(
      0, rows, model.frozen_states(ids.index_select(0, rows), tokens.mask.index_select(0, rows)));
}

}  // namespace

KeyQueue::KeyQueue(int64_t size, int64_t width)
    : size_(size),
      keys_(register_buffer("keys", torch::zeros({size, width}))),
      group_(register_buffer("group", torch::zeros({size}, torch::kLong))),
      caption_(register_buffer("caption", torch::zeros({size}, torch::kLong))),
      meaning_(register_buffer("meaning", torch::zeros({size}, torch::kLong))),
      pushed_(register_buffer("pushed", torch::zeros({1}, torch::kLong))) {}

void KeyQueue::push(const at::Tensor& keys, const PairIdentity& identity) {
  at::NoGradGuard no_grad;
  const int64_t before = pushed_.item<int64_t>(), count = keys.size(0);
  const int64_t skipped = std::max<int64_t>(0, count - size_);
  const at::Tensor place =
      torch::arange(before + skipped, before + count, torch::kLong).remainder(size_);
  keys_.index_copy_(0, place, keys.slice(0, skipped));
  group_.index_copy_(0, place, identity.group.slice(0, skipped));
  caption_.index_copy_(0, place, identity.caption.slice(0, skipped));
  meaning_.index_copy_(0, place, identity.meaning.slice(0, skipped));
  pushed_.add_(count);
}

int64_t KeyQueue::filled() const { return std::min(size_, pushed_.item<int64_t>()); }

at::Tensor KeyQueue::keys() const { return keys_.slice(0, 0, filled()); }

PairIdentity KeyQueue::identity() const {
  return {group_.slice(0, 0, filled()), caption_.slice(0, 0, filled()),
          meaning_.slice(0, 0, filled())};
}

void update_twin(torch::nn::Module& twin, torch::nn::Module& online, double momentum) {
  at::NoGradGuard no_grad;
  const auto values = online.named_parameters();
  for (auto& item : twin.named_parameters()) {
    item.value().lerp_(values[item.key()], 1 - momentum);
  }
  const auto buffers = online.named_buffers();
  for (auto& item : twin.named_buffers()) item.value().copy_(buffers[item.key()]);
}

BmmModel::BmmModel(const retriever::RetrieverConfig& config,
                   std::shared_ptr<encoders::TextTower> tower, retriever::Queues queues,
                   int64_t queue_size, double momentum, double temperature,
                   double same_meaning_weight)
    : queues_(queues),
      momentum_(momentum),
      same_meaning_weight_(same_meaning_weight),
      online_(
          register_module("online", std::make_shared<retriever::RetrieverModel>(config, tower))),
      twin_(register_module("twin", std::make_shared<retriever::RetrieverModel>(config, tower))),
      text_queue_(
          register_module("text_queue", std::make_shared<KeyQueue>(queue_size, config.embedding))),
      motion_queue_(register_module("motion_queue",
                                    std::make_shared<KeyQueue>(queue_size, config.embedding))),
      log_scale_(register_parameter("log_scale", torch::full({}, -std::log(temperature)))) {
  for (auto& value : twin_->parameters()) value.set_requires_grad(false);
  update_twin(*twin_, *online_, 0);
}

at::Tensor BmmModel::scale() const { return log_scale_.exp().clamp_max(kLargestScale); }

BmmModel::Keys BmmModel::make_keys(const PairBatch& batch) {
  at::NoGradGuard no_grad;
  twin_->eval();
  const retriever::TextVectors text = twin_->encode_text(batch.tokens.ids, batch.tokens.mask);
  const retriever::MotionVectors motion = twin_->motion_encoder().forward(batch.key_patches);
  return {text.query, motion.global, text.parts, motion.parts, batch.identity};
}

std::pair<at::Tensor, at::Tensor> BmmModel::keys(const PairBatch& batch) {
  const Keys made = make_keys(batch);
  return {made.text, made.motion};
}

at::Tensor BmmModel::part_loss(const at::Tensor& motion, const at::Tensor& text, const Keys& keys,
                               const at::Tensor& bias) const {
  const at::Tensor factor = scale();
  at::Tensor sum = torch::zeros({});
  for (int64_t part = 0; part < motion::kBodyParts; ++part) {
    sum = sum +
          contrast_loss(motion.select(1, part), keys.text_parts.select(1, part), {}, bias, {},
                        factor) +
          contrast_loss(text.select(1, part), keys.motion_parts.select(1, part), {}, bias, {},
                        factor);
  }
  return sum / (2 * motion::kBodyParts);
}

BmmLosses BmmModel::loss(const PairBatch& batch, double part_weight, double token_drop) {
  kept_ = make_keys(batch);
  const at::Tensor states =
      is_training() ? states_with_hidden_words(batch, token_drop, *online_) : batch.text_states;
  const retriever::TextVectors text = online_->read_states(states, batch.tokens.mask);
  const retriever::MotionVectors motion = online_->motion_encoder().forward(batch.online_patches);

  const at::Tensor factor = scale();
  const at::Tensor bias = negative_bias(batch.identity, batch.identity, same_meaning_weight_);
  const auto direction = [&](const at::Tensor& queries, const at::Tensor& keys,
                             const KeyQueue& queue, bool used) {
    if (!used || queue.filled() == 0) {
      return contrast_loss(queries, keys, {}, bias, {}, factor);
    }
    return contrast_loss(queries, keys, queue.keys(), bias,
                         negative_bias(batch.identity, queue.identity(), same_meaning_weight_),
                         factor);
  };
  const bool use_text = queues_ == retriever::Queues::text || queues_ == retriever::Queues::both;
  const bool use_motion =
      queues_ == retriever::Queues::motion || queues_ == retriever::Queues::both;
  const at::Tensor m2t = direction(motion.global, kept_.text, *text_queue_, use_text);
  const at::Tensor t2m = direction(text.query, kept_.motion, *motion_queue_, use_motion);

  BmmLosses losses{(m2t + t2m) / 2, m2t.item<double>(), t2m.item<double>(), 0};
  if (part_weight > 0) {
    const at::Tensor parts = part_loss(motion.parts, text.parts, kept_, bias);
    losses.parts = parts.item<double>();
    losses.total = losses.total + part_weight * parts;
  }
  return losses;
}

void BmmModel::after_step() {
  update_twin(*twin_, *online_, momentum_);
  text_queue_->push(kept_.text, kept_.identity);
  motion_queue_->push(kept_.motion, kept_.identity);
}

}  // namespace remomask::training
