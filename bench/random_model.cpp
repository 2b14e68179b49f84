#include "bench/random_model.h"

#include <torch/types.h>

#include "retriever/retriever_model.h"
#include "tokenizer/tokenizer_network.h"

namespace remomask {

namespace {

nn::ModelStage random_retriever_stage(retriever::RetrieverConfig config,
                                      const encoders::SentenceEncoder& words) {
  config.text_encoder = words.tower_hash();
  config.text_encoder_width = words.width();
  return {"retriever", nlohmann::json(config),
          nn::module_tensors(retriever::RetrieverModel(config, words.tower()))};
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

std::map<std::string, nn::ModelStage> random_stages(training::ModelConfig config,
                                                    const encoders::SentenceEncoder& words) {
  config.masked.text_width = config.residual.text_width = words.width();
  return {{"retriever", random_retriever_stage(config.retriever, words)},
          {"tokenizer", random_tokenizer_stage(config.tokenizer)},
          {"masked", generator::masked_stage(generator::MaskedTransformer(config.masked))},
          {"residual", generator::residual_stage(generator::ResidualTransformer(config.residual))}};
}

}  // namespace remomask
