#include "training/masked_words.h"

#include <torch/nn/functional/activation.h>
#include <torch/nn/functional/loss.h>
#include <torch/nn/modules/linear.h>
#include <torch/nn/modules/normalization.h>

#include <algorithm>
#include <set>

#include "base/hash.h"
#include "remomask/error.h"
#include "text/caption.h"

namespace remomask::training {

namespace {

/// Encoder with a head that predicts words; output weights are the embeddings.
class MaskedWordModel : public torch::nn::Module {
 public:
  explicit MaskedWordModel(const encoders::TextEncoderConfig& config)
      : encoder_(register_module("encoder", std::make_shared<encoders::TextEncoder>(config))),
        transform_(register_module("transform", torch::nn::Linear(config.width, config.width))),
        norm_(register_module("norm",
                              torch::nn::LayerNorm(torch::nn::LayerNormOptions({config.width})))),
        bias_(register_parameter("bias", torch::zeros({encoder_->wordpiece().size()}))) {
    nn::initialise_transformer_weights(*transform_);
  }

  /// Logits [n, V] at the hidden places alone, and their targets [n].
  std::pair<at::Tensor, at::Tensor> predict(const MaskedWords& words, const at::Tensor& mask) {
    const auto states = encoder_->encode(words.ids, mask).states;
    const auto hidden = words.target.ge(0);
    const auto chosen = norm_(torch::gelu(transform_(states.index({hidden}))));
    return {torch::linear(chosen, encoder_->token_weights(), bias_), words.target.index({hidden})};
  }

  encoders::TextEncoder& encoder() { return *encoder_; }

 private:
  std::shared_ptr<encoders::TextEncoder> encoder_;
  torch::nn::Linear transform_;
  torch::nn::LayerNorm norm_;
  at::Tensor bias_;
};

std::vector<std::string> distinct_captions(const std::vector<std::string>& captions) {
  std::set<std::string> distinct;
  for (const std::string& caption : captions) {
    std::string normal = text::normalise_caption(caption);
    if (!normal.empty()) distinct.insert(std::move(normal));
  }
  if (distinct.size() < 20) {
    throw Error("only " + std::to_string(distinct.size()) +
                " different captions to learn words from; at least 20 are needed");
  }
  return {distinct.begin(), distinct.end()};
}

}  // namespace

TextTrainingOptions::TextTrainingOptions() {
  trainer.stage_name = "text";
  trainer.steps = 1500;
  trainer.learning_rate = 1e-3;
  trainer.warmup_steps = 100;
  trainer.weight_decay = 0.01;
}

MaskedWords mask_words(const encoders::TokenBatch& batch, int64_t vocabulary_size, double share,
                       CounterRandom& random) {
  MaskedWords words{batch.ids.clone(), torch::full_like(batch.ids, -100)};
  const int64_t columns = batch.ids.size(1);
  for (int64_t row = 0; row < batch.ids.size(0); ++row) {
    int64_t* ids = words.ids.data_ptr<int64_t>() + row * columns;
    int64_t* target = words.target.data_ptr<int64_t>() + row * columns;
    std::vector<int64_t> places;
    for (int64_t s = 0; s < columns; ++s) {
      if (ids[s] != text::WordPiece::kPad && ids[s] != text::WordPiece::kStart &&
          ids[s] != text::WordPiece::kEnd) {
        places.push_back(s);
      }
    }
    if (places.empty()) continue;
    const std::vector<size_t> order = random.permutation(places.size());
    const auto count = std::max<size_t>(
        1, static_cast<size_t>(share * static_cast<double>(places.size()) + random.uniform()));
    for (size_t k = 0; k < std::min(count, places.size()); ++k) {
      const int64_t s = places[order[k]];
      target[s] = ids[s];
      const double fate = random.uniform();
      if (fate < 0.8) {
        ids[s] = text::WordPiece::kMask;
      } else if (fate < 0.9) {
        const auto words_only =
            static_cast<size_t>(vocabulary_size - text::WordPiece::kSpecialTokens);
        ids[s] = text::WordPiece::kSpecialTokens + static_cast<int64_t>(random.below(words_only));
      }
    }
  }
  return words;
}

nn::ModelStage train_text_encoder(const std::vector<std::string>& captions,
                                  encoders::TextEncoderConfig config,
                                  const TextTrainingOptions& options, const Monitor& monitor) {
  const std::vector<std::string> all = distinct_captions(captions);
  if (config.vocabulary.empty()) {
    std::vector<std::string> repeated;  // frequencies count, so every occurrence does
    for (const std::string& caption : captions)
      repeated.push_back(text::normalise_caption(caption));
    config.vocabulary = text::train_wordpiece(repeated, config.vocabulary_size);
  }
  std::vector<std::string> train, held_back;
  std::string content;
  for (size_t i = 0; i < all.size(); ++i) {
    (i % 20 == 19 ? held_back : train).push_back(all[i]);
    content += all[i] + '\n';
  }

  torch::manual_seed(options.trainer.seed);
  MaskedWordModel model(config);
  const int64_t words = model.encoder().wordpiece().size();
  const nlohmann::json identity = {{"config", config},
                                   {"captions", content_hash(content)},
                                   {"batch", options.batch},
                                   {"mask_share", options.mask_share}};
  Trainer trainer(model, options.trainer, identity);
  trainer.set_validation(options.validation_every, [&](int64_t) {
    double loss = 0, correct = 0, count = 0;
    for (size_t first = 0; first < held_back.size(); first += 64) {
      const size_t last = std::min(held_back.size(), first + 64);
      const encoders::TokenBatch batch =
          model.encoder().tokenize({held_back.begin() + static_cast<std::ptrdiff_t>(first),
                                    held_back.begin() + static_cast<std::ptrdiff_t>(last)});
      CounterRandom random(options.trainer.seed, mix_seed(0x76616c, first));
      const auto [logits, target] =
          model.predict(mask_words(batch, words, options.mask_share, random), batch.mask);
      const auto n = static_cast<double>(target.size(0));
      loss += n * torch::cross_entropy_loss(logits, target).item<double>();
      correct += logits.argmax(1).eq(target).sum().item<double>();
      count += n;
    }
    return std::map<std::string, double>{{"val_loss", loss / count},
                                         {"val_accuracy", correct / count}};
  });
  trainer.run(
      [&](int64_t step) {
        CounterRandom random(options.trainer.seed, mix_seed(0x6d6c6d, static_cast<uint64_t>(step)));
        std::vector<std::string> chosen;
        for (int64_t i = 0; i < options.batch; ++i) {
          chosen.push_back(train[random.below(train.size())]);
        }
        const encoders::TokenBatch batch = model.encoder().tokenize(chosen);
        const auto [logits, target] =
            model.predict(mask_words(batch, words, options.mask_share, random), batch.mask);
        return StepResult{torch::cross_entropy_loss(logits, target), {}};
      },
      monitor);

  nn::ModelStage stage;
  stage.kind = "text";
  stage.config = config;
  stage.config["history"] = trainer.history();
  stage.tensors = nn::module_tensors(model.encoder());
  return stage;
}

}  // namespace remomask::training
