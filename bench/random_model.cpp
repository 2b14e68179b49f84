#include "bench/random_model.h"

#include <torch/types.h>

#include "retriever/retriever_model.h"
#include "synthetic/procedural.h"
#include "text/caption.h"
#include "tokenizer/tokenizer_network.h"

namespace remomask {

namespace {

nn::ModelStage random_retriever_stage(retriever::RetrieverConfig config) {
  synthetic::ProceduralOptions options;
  options.count = 60;
  std::vector<std::string> captions;
  for (const synthetic::ProceduralClip& clip : synthetic::make_procedural_clips(options)) {
    for (const std::string& caption : clip.captions)
      captions.push_back(text::normalise_caption(caption));
  }
  encoders::TextEncoderConfig text =
      encoders::text_encoder_preset(parse_preset(config.preset).size);
  text.vocabulary = text::train_wordpiece(captions, text.vocabulary_size);
  config.text_tower = encoders::TextEncoder(text).config();
  return {"retriever", nlohmann::json(config),
          nn::module_tensors(retriever::RetrieverModel(config))};
}

}  // namespace

nn::ModelStage random_tokenizer_stage(const tokenizer::TokenizerConfig& config) {
  tokenizer::TokenizerNetwork network(config);
  tokenizer::ResidualQuantizer& quantizer = network->quantizer();
  for (int64_t level = 0; level < config.levels; ++level) {
    quantizer->set_codebook(level, torch::randn_like(quantizer->codebook(level)));
  }
  return {"tokenizer", nlohmann::json(config), nn::module_tensors(*network)};
}

std::map<std::string, nn::ModelStage> random_stages(const training::ModelConfig& config) {
  return {{"retriever", random_retriever_stage(config.retriever)},
          {"tokenizer", random_tokenizer_stage(config.tokenizer)},
          {"masked", generator::masked_stage(generator::MaskedTransformer(config.masked))},
          {"residual", generator::residual_stage(generator::ResidualTransformer(config.residual))}};
}

}  // namespace remomask
