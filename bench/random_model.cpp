#include "bench/random_model.h"

#include <torch/types.h>

#include "generator/tokenizer_network.h"
#include "motion/procedural.h"
#include "retriever/retriever_model.h"
#include "text/caption.h"

namespace remomask {

namespace {

ModelStage random_retriever_stage(RetrieverConfig config) {
  ProceduralOptions options;
  options.count = 60;
  std::vector<std::string> captions;
  for (const ProceduralClip& clip : make_procedural_clips(options)) {
    for (const std::string& caption : clip.captions) captions.push_back(normalise_caption(caption));
  }
  TextEncoderConfig text = text_encoder_preset(config.preset);
  text.vocabulary = train_wordpiece(captions, text.vocabulary_size);
  config.text_tower = TextEncoder(text).config();
  return {"retriever", nlohmann::json(config), module_tensors(RetrieverModel(config))};
}

}  // namespace

ModelStage random_tokenizer_stage(const TokenizerConfig& config) {
  TokenizerNetwork network(config);
  ResidualQuantizer& quantizer = network->quantizer();
  for (int64_t level = 0; level < config.levels; ++level) {
    quantizer->set_codebook(level, torch::randn_like(quantizer->codebook(level)));
  }
  return {"tokenizer", nlohmann::json(config), module_tensors(*network)};
}

std::map<std::string, ModelStage> random_stages(const ModelConfig& config) {
  return {{"retriever", random_retriever_stage(config.retriever)},
          {"tokenizer", random_tokenizer_stage(config.tokenizer)},
          {"masked", masked_stage(MaskedTransformer(config.masked))},
          {"residual", residual_stage(ResidualTransformer(config.residual))}};
}

}  // namespace remomask
