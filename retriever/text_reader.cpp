#include "retriever/text_reader.h"

namespace remomask::retriever {

TextReader::TextReader(const RetrieverConfig& config, int64_t tower_width)
    : enter_(register_module("enter", torch::nn::Linear(tower_width, config.text_width))),
      stack_(register_module(
          "stack", nn::EncoderStack(config.text_layers, config.text_width, config.text_heads,
                                    config.text_hidden, config.text_dropout))) {
  nn::initialise_transformer_weights(*stack_);
}

at::Tensor TextReader::forward(const at::Tensor& states, const at::Tensor& mask) {
  const at::Tensor read = stack_(enter_(states), mask);
  const at::Tensor share = mask.to(read.scalar_type()).unsqueeze(2);
  return (read * share).sum(1) / share.sum(1);
}

}  // namespace remomask::retriever
