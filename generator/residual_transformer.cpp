#include "generator/residual_transformer.h"

#include <torch/types.h>

#include <cmath>

#include "remomask/error.h"

namespace remomask::generator {

namespace {

SstaConfig residual_stack_config(const ResidualConfig& config) {
  return {config.rows,          config.width,      config.heads,           config.hidden,
          config.dropout,       config.text_width, config.embedding_width, /*retrieval=*/false,
          /*hit_states=*/false, config.attention};
}

}  // namespace

ResidualTransformerImpl::ResidualTransformerImpl(const ResidualConfig& config)
    : config_(config),
      tables_(register_parameter(
          "tables", torch::randn({config.levels, config.rows, config.codes, config.width}) * 0.02)),
      level_table_(
          register_module("level_table", torch::nn::Embedding(config.levels, config.width))),
      stack_(register_module("stack",
                             make_attention_stack(residual_stack_config(config), config.layers))) {
  torch::NoGradGuard no_grad;
  level_table_->weight.normal_(0, 0.02);
  stack_->initialise();
}

std::vector<ConditionCache> ResidualTransformerImpl::prepare(const Condition& condition) {
  return stack_->prepare(condition);
}

at::Tensor ResidualTransformerImpl::forward(const at::Tensor& tokens, const at::Tensor& level,
                                            const std::vector<ConditionCache>& condition,
                                            const at::Tensor& frame_mask,
                                            std::vector<at::Tensor>* after_block) {
  const int64_t batch = tokens.size(0), frames = tokens.size(1), rows = config_.rows;
  const int64_t codes = config_.codes, width = config_.width, count = frames * rows;
  const auto device_level = level.to(tokens.device());
  auto x = level_table_(device_level).unsqueeze(1).expand({batch, count, width});
  const auto row_offset = torch::arange(rows, tokens.options()) * codes;
  const int64_t highest = level.max().item<int64_t>();
  for (int64_t below = 0; below < highest; ++below) {
    const auto index = (tokens.select(3, below) + row_offset).reshape({batch, count});
    const auto embedded = torch::embedding(tables_[below].reshape({rows * codes, width}), index);
    x = x + embedded * (device_level > below).to(embedded.dtype()).reshape({batch, 1, 1});
  }
  x = stack_->forward(x * std::sqrt(static_cast<double>(width)), condition, frame_mask,
                      after_block);

  // Samples of one level go through its projection together.
  std::vector<at::Tensor> parts, places;
  for (int64_t l = 1; l < config_.levels; ++l) {
    const auto place = torch::nonzero(level == l).squeeze(1).to(tokens.device());
    if (place.size(0) == 0) continue;
    const auto by_row =
        x.index_select(0, place).reshape({place.size(0) * frames, rows, width}).transpose(0, 1);
    parts.push_back(torch::bmm(by_row, tables_[l].transpose(1, 2))
                        .transpose(0, 1)
                        .reshape({place.size(0), count, codes}));
    places.push_back(place);
  }
  if (parts.size() == 1) return parts[0];
  return torch::cat(parts, 0).index_select(0, torch::argsort(torch::cat(places, 0)));
}

ResidualConfig residual_config(nlohmann::json stage_config) {
  stage_config.emplace("attention", "ssta");
  return stage_config.get<ResidualConfig>();
}

nn::ModelStage residual_stage(const ResidualTransformer& model) {
  return {"residual", nlohmann::json(model->config()), nn::module_tensors(*model)};
}

ResidualTransformer load_residual(const nn::ModelStage& stage) {
  if (stage.kind != "residual") {
    throw Error("this stage is a " + stage.kind + ", not a residual transformer");
  }
  ResidualTransformer model(residual_config(stage.config));
  nn::load_module_tensors(*model, stage.tensors, "residual transformer");
  model->eval();
  return model;
}

}  // namespace remomask::generator
