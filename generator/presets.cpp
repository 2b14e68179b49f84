#include "generator/presets.h"

#include "base/error.h"

namespace remomask {

namespace {

void set_sizes(MaskedConfig& config, int64_t width, int64_t heads, int64_t layers, int64_t hidden) {
  config.width = width;
  config.heads = heads;
  config.layers = layers;
  config.hidden = hidden;
}

void set_sizes(ResidualConfig& config, int64_t width, int64_t heads, int64_t layers,
               int64_t hidden) {
  config.width = width;
  config.heads = heads;
  config.layers = layers;
  config.hidden = hidden;
}

/// MoMask's convolutions, which ReMoMask's tokenizer keeps, with given codes.
void set_convolutions(TokenizerConfig& config, int64_t width, int64_t codes, int64_t code_width) {
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
}

}  // namespace

ModelConfig model_preset(const std::string& preset) {
  ModelConfig model;
  model.masked.sequence_hits = 2;
  // The MoMask baseline has no retrieval; its text vector comes from the base retriever.
  if (preset == "tiny") {
    tiny_sizes(model);
  } else if (preset == "paper") {
    paper_sizes(model);
  } else if (preset == "momask") {
    momask_sizes(model);
  } else if (preset != "base") {
    throw Error("there is no preset \"" + preset + "\"; use tiny, base, paper or momask");
  }
  model.retriever = retriever_preset(preset == "momask" ? "base" : preset);
  model.tokenizer.preset = model.masked.preset = model.residual.preset = preset;
  for (int64_t* width : {&model.masked.embedding_width, &model.residual.embedding_width}) {
    *width = model.retriever.embedding;
  }
  model.masked.rows = model.residual.rows = model.tokenizer.rows;
  model.masked.codes = model.residual.codes = model.tokenizer.codes;
  model.residual.levels = model.tokenizer.levels;
  return model;
}

}  // namespace remomask
