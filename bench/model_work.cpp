#include "bench/model_work.h"

#include "base/time.h"
#include "remomask/error.h"
#include "tokenizer/part_map.h"
#include "tokenizer/tokenizer_network.h"

namespace remomask {

namespace {

int64_t hit_rows(const generator::SstaConfig& config, const ConditionSize& condition) {
  return config.retrieval ? condition.hits + 1 : 0;
}

int64_t guided_samples(double guidance) { return guidance == 1 ? 1 : 2; }

int64_t row_channels(const tokenizer::TokenizerConfig& config) {
  return config.rows == 1 ? skeleton_named(config.skeleton).feature_dim()
                          : motion::kPartSlots * tokenizer::kSlotChannels;
}

/// Multiply-adds per token frame in what encoder and decoder have in common: patches, residual
/// blocks, exchange between rows, and codes in or out.
double common_products(const tokenizer::TokenizerConfig& config) {
  if (config.widths.size() != 1) {
    throw Error("the work of a tokenizer is only known for one time scale");
  }
  const int64_t width = config.widths[0], rows = config.rows;
  const int64_t each_row = kFramesPerToken * row_channels(config) * width +
                           config.blocks[0] * 4 * width * width + 3 * width * config.code_width;
  const int64_t mixer = rows > 1 ? 2 * rows * width * config.mixer_width : 0;
  return static_cast<double>(rows * each_row + mixer);
}

}  // namespace

double prepare_flops(const generator::SstaConfig& config, int64_t layers,
                     const ConditionSize& condition) {
  const int64_t width = config.width, text_rows = condition.text_tokens + 1;
  const int64_t encoder =
      condition.text_tokens * config.text_width * width + config.embedding_width * width;
  const int64_t layer = text_rows * width * 2 * width +
                        hit_rows(config, condition) * (3 * config.embedding_width + 1) * width;
  return 2.0 * static_cast<double>(encoder + layers * layer);
}

double stack_flops(const generator::SstaConfig& config, int64_t layers,
                   const ConditionSize& condition, int64_t frames) {
  const int64_t tokens = frames * config.rows, width = config.width;
  const int64_t keys = tokens + condition.text_tokens + 1 + hit_rows(config, condition);
  const int64_t projections = tokens * 4 * width * width;
  const int64_t attention = 2 * tokens * keys * width;
  const int64_t feed_forward = 2 * tokens * width * config.hidden;
  return 2.0 * static_cast<double>(layers * (projections + attention + feed_forward));
}

generator::SstaConfig stack_config(const generator::MaskedConfig& config) {
  return {config.rows,    config.width,      config.heads,           config.hidden,
          config.dropout, config.text_width, config.embedding_width, config.max_hits > 0};
}

generator::SstaConfig stack_config(const generator::ResidualConfig& config) {
  return {config.rows,    config.width,      config.heads,           config.hidden,
          config.dropout, config.text_width, config.embedding_width, /*retrieval=*/false};
}

double sample_base_flops(const generator::MaskedConfig& config, const SamplingOptions& options,
                         const ConditionSize& condition, int64_t frames) {
  const generator::SstaConfig stack = stack_config(config);
  const int64_t tokens = frames * config.rows;
  const auto passes = static_cast<double>(generator::masked_counts(tokens, options.steps).size()) +
                      options.correction_rounds;
  const double head = 2.0 * static_cast<double>(tokens * config.width * config.codes);
  const double sample = prepare_flops(stack, config.layers, condition) +
                        passes * (stack_flops(stack, config.layers, condition, frames) + head);
  return static_cast<double>(guided_samples(options.guidance)) * sample;
}

double sample_residual_flops(const generator::ResidualConfig& config,
                             const SamplingOptions& options, const ConditionSize& condition,
                             int64_t frames) {
  const generator::SstaConfig stack = stack_config(config);
  const auto passes = static_cast<double>(config.levels - 1);
  const double head = 2.0 * static_cast<double>(frames * config.rows * config.width * config.codes);
  const double sample = prepare_flops(stack, config.layers, condition) +
                        passes * (stack_flops(stack, config.layers, condition, frames) + head);
  return static_cast<double>(guided_samples(options.residual_guidance)) * sample;
}

double encode_flops(const tokenizer::TokenizerConfig& config, int64_t frames) {
  const int64_t quantiser = config.rows * config.levels * config.codes * config.code_width;
  return 2.0 * static_cast<double>(frames) *
         (common_products(config) + static_cast<double>(quantiser));
}

double decode_flops(const tokenizer::TokenizerConfig& config, int64_t frames) {
  const int64_t smooth =
      kFramesPerToken * config.rows * 2 * 3 * row_channels(config) * config.smooth_width;
  return 2.0 * static_cast<double>(frames) *
         (common_products(config) + static_cast<double>(smooth));
}

}  // namespace remomask
