#include "training/words_training.h"

#include <torch/types.h>
#include <torch/utils.h>

#include <algorithm>
#include <limits>
#include <map>

#include "base/random.h"
#include "encoders/bert_encoder.h"
#include "remomask/error.h"

namespace remomask::training {

namespace {

constexpr uint64_t kAdapterStream = 0x61646170, kBatchStream = 0x776f7264;
constexpr uint64_t kValidationSeed = 0x76616c, kGeneralStream = 0x67656e;
constexpr int64_t kValidationBatches = 8, kGeneralValidationTexts = 64;
constexpr size_t kMostWords = 6;  // of a general text
constexpr double kOneClip = 0.5;  // share of the pairs that are of one clip
constexpr double kShortestVector = 1e-12;

std::set<std::string> text_values(const nlohmann::json& labels, const char* key) {
  std::set<std::string> values;
  const auto label = labels.find(key);
  if (label == labels.end()) return values;
  if (label->is_string()) values.insert(label->get<std::string>());
  if (!label->is_array()) return values;
  for (const auto& value : *label) {
    if (value.is_string()) values.insert(value.get<std::string>());
  }
  return values;
}

/// The captions of one step: `left[i]` and `right[i]` say the same.
struct CaptionPairs {
  std::vector<const CaptionClass*> classes;
  std::vector<std::string> left, right;
};

std::pair<std::string, std::string> draw_pair(const CaptionClass& one, CounterRandom& random) {
  const std::vector<std::string>* captions = &one.captions;
  if (random.uniform() < kOneClip) {
    const auto& clip = one.clips[random.below(one.clips.size())];
    if (clip.size() > 1) captions = &clip;
  }
  const size_t first = random.below(captions->size());
  const size_t step = 1 + random.below(captions->size() - 1);
  return {(*captions)[first], (*captions)[(first + step) % captions->size()]};
}

CaptionPairs draw_pairs(const std::vector<CaptionClass>& classes, int64_t batch, uint64_t seed) {
  CounterRandom random(seed, kBatchStream);
  std::vector<size_t> order = random.permutation(classes.size());
  order.resize(std::min(order.size(), static_cast<size_t>(batch)));
  CaptionPairs pairs;
  for (const size_t i : order) {
    auto [left, right] = draw_pair(classes[i], random);
    pairs.classes.push_back(&classes[i]);
    pairs.left.push_back(std::move(left));
    pairs.right.push_back(std::move(right));
  }
  return pairs;
}

/// Words of a vocabulary that stand by themselves.
std::vector<std::string> whole_words(const std::vector<std::string>& vocabulary) {
  std::vector<std::string> words;
  std::copy_if(vocabulary.begin(), vocabulary.end(), std::back_inserter(words),
               [](const std::string& piece) {
                 return piece.size() > 1 && std::all_of(piece.begin(), piece.end(), [](char c) {
                          return c >= 'a' && c <= 'z';
                        });
               });
  return words;
}

std::vector<std::string> draw_texts(const std::vector<std::string>& words, int64_t count,
                                    uint64_t seed) {
  CounterRandom random(seed, kGeneralStream);
  std::vector<std::string> texts;
  for (int64_t i = 0; i < count; ++i) {
    std::string text;
    for (size_t w = random.below(kMostWords) + 1; w > 0; --w) {
      text += (text.empty() ? "" : " ") + words[random.below(words.size())];
    }
    texts.push_back(std::move(text));
  }
  return texts;
}

at::Tensor unit_vectors(encoders::BertEncoder& encoder, const std::vector<std::string>& texts) {
  const encoders::TokenBatch tokens = encoder.tokenize(texts);
  const at::Tensor pooled = encoder.encode(tokens.ids, tokens.mask).pooled;
  return pooled / pooled.norm(2, -1, /*keepdim=*/true).clamp_min(kShortestVector);
}

/// [B, B], true where the columns' captions may not be pushed away from the rows'.
at::Tensor unknown_negatives(const std::vector<const CaptionClass*>& classes) {
  const auto count = static_cast<int64_t>(classes.size());
  at::Tensor mask = torch::zeros({count, count}, torch::kBool);
  auto places = mask.accessor<bool, 2>();
  for (int64_t i = 0; i < count; ++i) {
    for (int64_t j = 0; j < count; ++j) {
      places[i][j] = i != j && may_mean_the_same(*classes[static_cast<size_t>(i)],
                                                 *classes[static_cast<size_t>(j)]);
    }
  }
  return mask;
}

/// What is trained, and what it is compared with.
class WordsTask {
 public:
  WordsTask(const nn::ModelStage& text, const WordsTrainingOptions& options)
      : options_(options),
        config_(encoders::read_bert_config(text.config)),
        plain_(config_, text.tensors, "text encoder"),
        adapted_(config_, text.tensors, "text encoder"),
        words_(whole_words(config_.vocabulary)) {
    if (words_.empty()) throw Error("the text encoder's vocabulary holds no whole word");
    torch::manual_seed(mix_seed(options.trainer.seed, kAdapterStream));
    adapter_ = std::make_shared<encoders::LowRankAdapter>(options.adapter,
                                                          encoders::bert_linear_layers(config_));
    adapted_.set_adapter(adapter_);
    plain_.eval();
    adapted_.eval();
  }

  encoders::LowRankAdapter& adapter() { return *adapter_; }

  StepResult step(const std::vector<CaptionClass>& classes, int64_t number) {
    const uint64_t seed = mix_seed(options_.trainer.seed, static_cast<uint64_t>(number));
    const CaptionPairs pairs = draw_pairs(classes, options_.batch, seed);
    const at::Tensor likeness = cosines(pairs) / options_.temperature;
    const at::Tensor masked = likeness.masked_fill(unknown_negatives(pairs.classes),
                                                   -std::numeric_limits<float>::infinity());
    const at::Tensor right = torch::arange(masked.size(0));
    const at::Tensor contrast = (torch::nll_loss(torch::log_softmax(masked, 1), right) +
                                 torch::nll_loss(torch::log_softmax(masked.t(), 1), right)) /
                                2;
    const at::Tensor moved = change(draw_texts(words_, options_.general_texts, seed));
    StepResult result;
    result.loss = contrast + options_.general_weight * moved.square().mean();
    result.figures = {{"contrast", contrast.item<double>()},
                      {"moved", moved.detach().abs().mean().item<double>()}};
    return result;
  }

  std::map<std::string, double> validate(const std::vector<CaptionClass>& classes) {
    at::NoGradGuard no_grad;
    double right = 0, all = 0;
    for (int64_t i = 0; i < kValidationBatches; ++i) {
      const CaptionPairs pairs =
          draw_pairs(classes, options_.batch, mix_seed(kValidationSeed, static_cast<uint64_t>(i)));
      const at::Tensor nearest =
          cosines(pairs).masked_fill(unknown_negatives(pairs.classes), -1).argmax(1);
      right += nearest.eq(torch::arange(nearest.size(0))).sum().item<double>();
      all += static_cast<double>(nearest.size(0));
    }
    const at::Tensor moved = change(draw_texts(words_, kGeneralValidationTexts, kValidationSeed));
    return {{"nearest_right", right / std::max(1.0, all)},
            {"general_change", moved.abs().mean().item<double>()}};
  }

 private:
  /// [B, B] of the left captions and the right ones.
  at::Tensor cosines(const CaptionPairs& pairs) {
    std::vector<std::string> texts = pairs.left;
    texts.insert(texts.end(), pairs.right.begin(), pairs.right.end());
    const at::Tensor vectors = unit_vectors(adapted_, texts);
    const auto count = static_cast<int64_t>(pairs.left.size());
    return torch::matmul(vectors.narrow(0, 0, count), vectors.narrow(0, count, count).t());
  }

  /// By how much the adapter moves the cosines between these texts.
  at::Tensor change(const std::vector<std::string>& texts) {
    at::Tensor before;
    {
      at::NoGradGuard no_grad;
      const at::Tensor vectors = unit_vectors(plain_, texts);
      before = torch::matmul(vectors, vectors.t());
    }
    const at::Tensor vectors = unit_vectors(adapted_, texts);
    return torch::matmul(vectors, vectors.t()) - before;
  }

  const WordsTrainingOptions& options_;
  encoders::BertConfig config_;
  encoders::BertEncoder plain_, adapted_;
  std::vector<std::string> words_;
  std::shared_ptr<encoders::LowRankAdapter> adapter_;
};

nlohmann::json words_run_identity(const nn::ModelStage& text,
                                  const std::vector<CaptionClass>& train,
                                  const WordsTrainingOptions& options) {
  size_t captions = 0;
  for (const CaptionClass& one : train) captions += one.captions.size();
  return {{"text", nn::stage_hash(text)},
          {"classes", train.size()},
          {"captions", captions},
          {"rank", options.adapter.rank},
          {"alpha", options.adapter.alpha},
          {"batch", options.batch},
          {"temperature", options.temperature},
          {"general_texts", options.general_texts},
          {"general_weight", options.general_weight}};
}

}  // namespace

std::vector<CaptionClass> caption_classes(const std::vector<db::Clip>& clips,
                                          const std::string& split) {
  std::map<std::string, CaptionClass> by_key;
  for (const db::Clip& clip : clips) {
    if (clip.split != split || clip.captions.empty()) continue;
    const std::set<std::string> actions = text_values(clip.labels, "actions");
    const std::set<std::string> styles = text_values(clip.labels, "style");
    const std::string style = styles.empty() ? "" : *styles.begin();
    std::string key = actions.empty() && style.empty() ? "clip " + clip.name : "class " + style;
    for (const std::string& action : actions) key += '\n' + action;
    CaptionClass& one = by_key[key];
    one.actions = actions;
    one.style = style;
    one.clips.push_back(clip.captions);
    one.captions.insert(one.captions.end(), clip.captions.begin(), clip.captions.end());
  }
  std::vector<CaptionClass> classes;
  for (auto& [key, one] : by_key) {
    for (auto& clip : one.clips) {
      std::sort(clip.begin(), clip.end());
      clip.erase(std::unique(clip.begin(), clip.end()), clip.end());
    }
    std::sort(one.captions.begin(), one.captions.end());
    one.captions.erase(std::unique(one.captions.begin(), one.captions.end()), one.captions.end());
    if (one.captions.size() > 1) classes.push_back(std::move(one));
  }
  return classes;
}

bool may_mean_the_same(const CaptionClass& left, const CaptionClass& right) {
  if (left.actions.empty() || right.actions.empty()) return false;
  if (!left.style.empty() && !right.style.empty() && left.style != right.style) return false;
  return std::includes(left.actions.begin(), left.actions.end(), right.actions.begin(),
                       right.actions.end()) ||
         std::includes(right.actions.begin(), right.actions.end(), left.actions.begin(),
                       left.actions.end());
}

nn::ModelStage train_words(const nn::ModelStage& text, const std::vector<CaptionClass>& train,
                           const std::vector<CaptionClass>& val,
                           const WordsTrainingOptions& options, const Monitor& monitor) {
  if (train.size() < 2) {
    throw Error(
        "there are fewer than two kinds of clips with two captions in the split train; the words "
        "of one kind are told from nothing");
  }
  WordsTask task(text, options);
  Trainer trainer(task.adapter(), options.trainer, words_run_identity(text, train, options));
  if (val.size() > 1) {
    trainer.set_validation(options.validate_every, [&](int64_t) { return task.validate(val); });
  }
  trainer.run([&](int64_t step) { return task.step(train, step); }, monitor);
  nn::ModelStage stage = encoders::adapter_stage(task.adapter(), nn::stage_hash(text));
  stage.config["training"] = {{"steps", options.trainer.steps},
                              {"seed", options.trainer.seed},
                              {"classes", train.size()},
                              {"history", trainer.history()}};
  return stage;
}

}  // namespace remomask::training
