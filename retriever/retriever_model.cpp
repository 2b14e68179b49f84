#include "retriever/retriever_model.h"

#include "motion/body_parts.h"

namespace remomask::retriever {

RetrieverModel::RetrieverModel(const RetrieverConfig& config)
    : config_(config),
      tower_(register_module("text_tower", encoders::make_text_tower(config.text_tower))),
      motion_(register_module("motion", std::make_shared<MotionEncoder>(config))),
      text_head_(register_module(
          "text_head",
          std::make_shared<ProjectionHead>(tower_->width(), config.embedding, config.dropout))),
      text_parts_(register_module(
          "text_parts",
          torch::nn::Linear(tower_->width(), motion::kBodyParts * config.part_embedding))) {}

TextVectors RetrieverModel::encode_text(const at::Tensor& ids, const at::Tensor& mask) {
  const encoders::TextStates text = tower_->encode(ids, mask);
  return {text.states, text_head_->forward(text.pooled),
          unit_rows(
              text_parts_(text.pooled).unflatten(1, {motion::kBodyParts, config_.part_embedding}))};
}

}  // namespace remomask::retriever
