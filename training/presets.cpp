#include "training/presets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>

#include "remomask/error.h"

namespace remomask::training {

namespace {

void set_sizes(generator::MaskedConfig& config, int64_t width, int64_t heads, int64_t layers,
               int64_t hidden) {
  config.width = width;
  config.heads = heads;
  config.layers = layers;
  config.hidden = hidden;
}

void set_sizes(generator::ResidualConfig& config, int64_t width, int64_t heads, int64_t layers,
               int64_t hidden) {
  config.width = width;
  config.heads = heads;
  config.layers = layers;
  config.hidden = hidden;
}

/// MoMask's convolutions, which ReMoMask's tokenizer keeps, with given codes.
void set_convolutions(tokenizer::TokenizerConfig& config, int64_t width, int64_t codes,
                      int64_t code_width) {
  config.widths = {width, width, width};
  config.blocks = {0, 3, 3};
  config.dropout = 0.2;
  config.codes = codes;
  config.code_width = code_width;
}

void tiny_sizes(ModelConfig& model) {
  model.tokenizer.codes = 32;
  model.tokenizer.levels = 3;
  model.tokenizer.code_width = 16;
  model.tokenizer.widths = {32};
  model.tokenizer.blocks = {2};
  model.tokenizer.mixer_width = 64;
  model.tokenizer.smooth_width = 16;
  set_sizes(model.masked, 64, 2, 2, 128);
  set_sizes(model.residual, 64, 2, 2, 128);
}

void small_sizes(ModelConfig& model) {
  model.tokenizer.codes = 128;
  model.tokenizer.levels = 4;
  model.tokenizer.code_width = 32;
  model.tokenizer.widths = {64};
  model.tokenizer.blocks = {4};
  model.tokenizer.mixer_width = 192;
  model.tokenizer.smooth_width = 32;
  set_sizes(model.masked, 128, 4, 3, 256);
  set_sizes(model.residual, 128, 4, 3, 256);
}

void paper_sizes(ModelConfig& model) {
  set_convolutions(model.tokenizer, 512, 256, 1024);
  set_sizes(model.masked, 512, 8, 6, 1024);
  set_sizes(model.residual, 384, 6, 6, 1024);
  model.masked.dropout = model.residual.dropout = 0.2;
}

void momask_sizes(ModelConfig& model) {
  set_convolutions(model.tokenizer, 512, 512, 512);
  model.tokenizer.rows = 1;
  set_sizes(model.masked, 384, 6, 8, 1024);
  set_sizes(model.residual, 384, 6, 8, 1024);
  model.masked.dropout = model.residual.dropout = 0.2;
  model.masked.max_hits = 0;
  model.masked.attention = model.residual.attention = "joined";
}

}  // namespace

void use_one_row(ModelConfig& model) {
  tokenizer::TokenizerConfig& tokenizer = model.tokenizer;
  tokenizer.rows = model.masked.rows = model.residual.rows = 1;
  tokenizer.codes *= 2;
  model.masked.codes = model.residual.codes = tokenizer.codes;
  // Weights grow with the square of the width: (5/2)^2 is about six rows.
  for (int64_t& width : tokenizer.widths) width = width * 5 / 2;
  tokenizer.smooth_width = tokenizer.smooth_width * 5 / 2;
  tokenizer.code_width *= 2;
  model.masked.max_hits = model.masked.sequence_hits = 0;
  model.masked.attention = model.residual.attention = "joined";
}

ModelConfig model_preset(const Preset& preset) {
  ModelConfig model;
  model.masked.sequence_hits = 2;
  switch (preset.size) {
    case ModelSize::tiny:
      tiny_sizes(model);
      break;
    case ModelSize::small:
      small_sizes(model);
      break;
    case ModelSize::base:
      break;
    case ModelSize::paper:
      paper_sizes(model);
      break;
    case ModelSize::momask:
      momask_sizes(model);
      break;
  }
  // MoMask has no retrieval; its text vector comes from the base retriever.
  model.retriever = retriever::retriever_preset(preset.size);
  model.tokenizer.preset = model.masked.preset = model.residual.preset = preset_name(preset);
  for (int64_t* width : {&model.masked.embedding_width, &model.residual.embedding_width}) {
    *width = model.retriever.embedding;
  }
  model.masked.rows = model.residual.rows = model.tokenizer.rows;
  model.masked.codes = model.residual.codes = model.tokenizer.codes;
  model.residual.levels = model.tokenizer.levels;
  if (preset.one_row) use_one_row(model);
  return model;
}

}  // namespace remomask::training
