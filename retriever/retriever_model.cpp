#include "retriever/retriever_model.h"

#include "motion/body_parts.h"

namespace remomask::retriever {

RetrieverModel::RetrieverModel(const RetrieverConfig& config,
                               std::shared_ptr<encoders::TextTower> tower)
    : config_(config),
      tower_(std::move(tower)),
      reader_(register_module("text_reader",
                              std::make_shared<TextReader>(config, config.text_encoder_width))),
      motion_(register_module("motion", std::make_shared<MotionEncoder>(config))),
      text_head_(register_module(
          "text_head",
          std::make_shared<ProjectionHead>(config.text_width, config.embedding, config.dropout))),
      text_parts_(register_module(
          "text_parts",
          torch::nn::Linear(config.text_width, motion::kBodyParts * config.part_embedding))) {
  if (config.tuned_text_layers > 0) {
    tail_ = register_module("text_tail", tower_->tail(config.tuned_text_layers));
  }
}

at::Tensor RetrieverModel::frozen_states(const at::Tensor& ids, const at::Tensor& mask) const {
  const at::NoGradGuard frozen;
  return tower_->encode_below(ids, mask, config_.tuned_text_layers);
}

TextVectors RetrieverModel::read_states(const at::Tensor& frozen, const at::Tensor& mask) {
  const at::Tensor states = tail_ ? tail_->forward(frozen, mask) : frozen;
  const at::Tensor pooled = reader_->forward(states, mask);
  return {
      states, text_head_->forward(pooled),
      unit_rows(text_parts_(pooled).unflatten(1, {motion::kBodyParts, config_.part_embedding}))};
}

TextVectors RetrieverModel::encode_text(const at::Tensor& ids, const at::Tensor& mask) {
  return read_states(frozen_states(ids, mask), mask);
}

}  // namespace remomask::retriever
