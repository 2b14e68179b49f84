#include "training/transformer_training.h"

#include <torch/types.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "remomask/error.h"
#include "training/masking.h"
#include "training/start_weights.h"
#include "training/token_loss.h"

namespace remomask::training {

namespace {

/// What one step trains on.
struct TransformerBatch {
  at::Tensor tokens;      // [B, T, rows] or [B, T, rows, levels]: the input
  at::Tensor targets;     // [B, T, rows], -1 where nothing is asked
  at::Tensor level;       // residual model: [B]
  at::Tensor frame_mask;  // [B, T] or undefined
  generator::Condition condition;
};

/// Which clips come in which step; keeps the batches of the present epoch.
class BatchSchedule {
 public:
  BatchSchedule(const std::vector<TokenClip>& clips, int64_t batch, uint64_t seed)
      : clips_(clips), batch_(batch), seed_(seed) {}

  const std::vector<size_t>& at_step(int64_t step) {
    const auto count = static_cast<int64_t>((clips_.size() + static_cast<size_t>(batch_) - 1) /
                                            static_cast<size_t>(batch_));
    const int64_t epoch = step / count;
    if (epoch != epoch_) {
      batches_ = length_buckets(clips_, batch_, seed_, static_cast<uint64_t>(epoch));
      epoch_ = epoch;
    }
    return batches_[static_cast<size_t>(step % count)];
  }

 private:
  const std::vector<TokenClip>& clips_;
  int64_t batch_;
  uint64_t seed_;
  int64_t epoch_ = -1;
  std::vector<std::vector<size_t>> batches_;
};

CounterRandom sample_random(uint64_t seed, int64_t step, size_t sample) {
  return CounterRandom(mix_seed(seed, static_cast<uint64_t>(step), sample + 1), 0x73616d70u);
}

double draw_ratio(CounterRandom& random) {
  return std::cos(std::numbers::pi / 2 * random.uniform());
}

/// Chooses offset and caption of a clip.
at::Tensor choose_view(const TokenClip& clip, CounterRandom& random, int64_t& caption) {
  const at::Tensor tokens = clip.tokens[random.below(clip.tokens.size())];
  caption = static_cast<int64_t>(random.below(clip.captions.size()));
  return tokens;
}

/// Masks the base level of one padded sample in place and marks its targets.
void mask_sample(int64_t frames, const GeneratorData& data, CounterRandom& random, int64_t* tokens,
                 int64_t* targets) {
  const MaskKind kind = draw_mask_kind(data.rows, random);
  const double ratio = draw_ratio(random);
  const auto mask = draw_mask(kind, frames, data.rows, ratio, random);
  for (size_t cell = 0; cell < mask.size(); ++cell) {
    if (!mask[cell]) continue;
    targets[cell] = tokens[cell];
    tokens[cell] = corrupt_token(tokens[cell], data.codes, data.codes, random);
  }
}

TransformerBatch masked_batch(const GeneratorData& data, const std::vector<size_t>& members,
                              const generator::MaskedConfig& config,
                              const TransformerTrainingOptions& options, int64_t step) {
  std::vector<at::Tensor> maps;
  std::vector<ConditionSample> samples;
  std::vector<CounterRandom> randoms;
  for (size_t b = 0; b < members.size(); ++b) {
    const TokenClip& clip = data.train.clips[members[b]];
    CounterRandom random = sample_random(options.trainer.seed, step, b);
    int64_t caption = 0;
    maps.push_back(choose_view(clip, random, caption).slice(2, 0, 1));
    ConditionDrop drop = draw_condition_drop(random);
    if (!config.drops_conditions) drop = {};
    const RetrievalTable& hits =
        random.uniform() < options.unfamiliar_hits ? data.train.unfamiliar_hits : data.train.hits;
    samples.push_back(
        {clip.captions[static_cast<size_t>(caption)],
         draw_hits(hits, clip.first_query + caption, config.max_hits, options.noise_hits, random),
         drop.use_text, drop.use_retrieval});
    randoms.push_back(random);
  }
  const PaddedTokens padded = pad_tokens(maps);
  TransformerBatch batch;
  batch.tokens = padded.tokens.squeeze(3).contiguous();
  batch.frame_mask = padded.frame_mask;
  batch.targets = torch::full_like(batch.tokens, -1);
  const int64_t cells = batch.tokens.size(1) * data.rows;
  for (size_t b = 0; b < members.size(); ++b) {
    const int64_t first = static_cast<int64_t>(b) * cells;
    mask_sample(maps[b].size(0), data, randoms[b], batch.tokens.data_ptr<int64_t>() + first,
                batch.targets.data_ptr<int64_t>() + first);
  }
  batch.condition = make_condition(data, samples, config.max_hits, config.sequence_hits);
  return batch;
}

TransformerBatch residual_batch(const GeneratorData& data, const std::vector<size_t>& members,
                                const generator::ResidualConfig& config,
                                const TransformerTrainingOptions& options, int64_t step) {
  std::vector<at::Tensor> maps;
  std::vector<ConditionSample> samples;
  std::vector<int64_t> levels;
  std::vector<CounterRandom> randoms;
  for (size_t b = 0; b < members.size(); ++b) {
    const TokenClip& clip = data.train.clips[members[b]];
    CounterRandom random = sample_random(options.trainer.seed, step, b);
    int64_t caption = 0;
    maps.push_back(choose_view(clip, random, caption));
    levels.push_back(1 +
                     static_cast<int64_t>(random.below(static_cast<size_t>(config.levels - 1))));
    const bool use_text = random.uniform() >= options.text_drop;
    samples.push_back({clip.captions[static_cast<size_t>(caption)], {}, use_text, false});
    randoms.push_back(random);
  }
  const PaddedTokens padded = pad_tokens(maps);
  TransformerBatch batch;
  batch.level = torch::tensor(levels, torch::kLong);
  batch.frame_mask = padded.frame_mask;
  batch.targets = residual_targets(padded.tokens, batch.level, padded.frame_mask);
  batch.tokens = padded.tokens.contiguous();
  if (options.history_corruption > 0) {
    const int64_t entries = batch.tokens.numel() / static_cast<int64_t>(members.size());
    for (size_t b = 0; b < members.size(); ++b) {
      int64_t* tokens = batch.tokens.data_ptr<int64_t>() + static_cast<int64_t>(b) * entries;
      for (int64_t i = 0; i < entries; ++i) {
        if (randoms[b].uniform() < options.history_corruption) {
          tokens[i] = static_cast<int64_t>(randoms[b].below(static_cast<size_t>(data.codes)));
        }
      }
    }
  }
  batch.condition = make_condition(data, samples, 0, 0);
  return batch;
}

/// Evenly spread validation clips in batches of similar length.
std::vector<std::vector<size_t>> validation_batches(const GeneratorData& data,
                                                    const TransformerTrainingOptions& options) {
  const size_t count = std::min(options.validation_clips, data.val.clips.size());
  std::vector<TokenClip> chosen;
  std::vector<size_t> numbers;
  for (size_t i = 0; i < count; ++i) {
    numbers.push_back(i * data.val.clips.size() / count);
    chosen.push_back(data.val.clips[numbers.back()]);
  }
  auto batches = length_buckets(chosen, options.batch, options.trainer.seed, 0);
  for (auto& batch : batches) {
    for (auto& clip : batch) clip = numbers[clip];
  }
  return batches;
}

/// Mean loss and accuracy weighted by the number of targets.
struct MeanLoss {
  double loss = 0, accuracy = 0, targets = 0;
  void add(const TokenLoss& batch) {
    const auto weight = static_cast<double>(batch.targets);
    loss += weight * batch.loss.item<double>();
    accuracy += weight * batch.accuracy;
    targets += weight;
  }
  double mean_loss() const { return loss / std::max(1.0, targets); }
  double mean_accuracy() const { return accuracy / std::max(1.0, targets); }
};

std::map<std::string, double> validate_masked(generator::MaskedTransformer& model,
                                              const GeneratorData& data,
                                              const TransformerTrainingOptions& options) {
  MeanLoss both, unfamiliar, text_only;
  int64_t number = 0;
  for (const auto& members : validation_batches(data, options)) {
    std::vector<at::Tensor> maps;
    std::vector<ConditionSample> samples, unfamiliar_samples;
    const int64_t max_hits = model->config().max_hits;
    for (const size_t member : members) {
      const TokenClip& clip = data.val.clips[member];
      maps.push_back(clip.tokens[0].slice(2, 0, 1));
      samples.push_back({clip.captions[0], best_hits(data.val.hits, clip.first_query, max_hits)});
      unfamiliar_samples.push_back(
          {clip.captions[0], best_hits(data.val.unfamiliar_hits, clip.first_query, max_hits)});
    }
    const PaddedTokens padded = pad_tokens(maps);
    auto tokens = padded.tokens.squeeze(3).contiguous();
    auto targets = torch::full_like(tokens, -1);
    const int64_t cells = tokens.size(1) * data.rows;
    for (size_t b = 0; b < members.size(); ++b) {
      CounterRandom random = sample_random(options.trainer.seed, -1 - number, b);
      const int64_t first = static_cast<int64_t>(b) * cells;
      mask_sample(maps[b].size(0), data, random, tokens.data_ptr<int64_t>() + first,
                  targets.data_ptr<int64_t>() + first);
    }
    ++number;
    const auto loss_under = [&](const generator::Condition& condition) {
      return token_loss(model->forward(tokens, model->prepare(condition), padded.frame_mask),
                        targets);
    };
    const int64_t sequence_hits = model->config().sequence_hits;
    generator::Condition condition = make_condition(data, samples, max_hits, sequence_hits);
    both.add(loss_under(condition));
    unfamiliar.add(loss_under(make_condition(data, unfamiliar_samples, max_hits, sequence_hits)));
    condition.use_retrieval = torch::zeros_like(condition.use_retrieval);
    text_only.add(loss_under(condition));
  }
  return {{"val_loss", both.mean_loss()},
          {"val_accuracy", both.mean_accuracy()},
          {"val_accuracy_unfamiliar_hits", unfamiliar.mean_accuracy()},
          {"val_accuracy_text_only", text_only.mean_accuracy()}};
}

std::map<std::string, double> validate_residual(generator::ResidualTransformer& model,
                                                const GeneratorData& data,
                                                const TransformerTrainingOptions& options) {
  MeanLoss mean;
  for (const auto& members : validation_batches(data, options)) {
    std::vector<at::Tensor> maps;
    std::vector<ConditionSample> samples;
    std::vector<int64_t> levels;
    for (const size_t member : members) {
      const TokenClip& clip = data.val.clips[member];
      maps.push_back(clip.tokens[0]);
      samples.push_back({clip.captions[0], {}, true, false});
      levels.push_back(1 + static_cast<int64_t>(levels.size()) % (data.levels - 1));
    }
    const PaddedTokens padded = pad_tokens(maps);
    const auto level = torch::tensor(levels, torch::kLong);
    const generator::Condition condition = make_condition(data, samples, 0, 0);
    mean.add(token_loss(
        model->forward(padded.tokens, level, model->prepare(condition), padded.frame_mask),
        residual_targets(padded.tokens, level, padded.frame_mask)));
  }
  return {{"val_loss", mean.mean_loss()}, {"val_accuracy", mean.mean_accuracy()}};
}

StepResult step_result(const TokenLoss& loss) { return {loss.loss, {{"accuracy", loss.accuracy}}}; }

nlohmann::json run_identity(const nlohmann::json& config, const GeneratorData& data,
                            const TransformerTrainingOptions& options) {
  nlohmann::json identity = options_document(options);
  identity["config"] = config;
  identity["clips"] = data.train.clips.size();
  identity["captions"] = data.captions.offsets.size() - 1;
  return identity;
}

void check_training_data(const GeneratorData& data) {
  if (data.train.clips.empty()) throw Error("training a transformer: there are no training clips");
}

/// What the data decide about a model.
template <typename Config>
void fit_config(Config& config, const GeneratorData& data) {
  config.rows = data.rows;
  config.codes = data.codes;
  config.text_width = data.captions.states.size(1);
  config.embedding_width = data.motion.size(1);
}

/// Trains `model` in place; make_batch(members, step), logits_of(batch) and
/// validate() are what tells the two transformers apart. Returns what the stage's config says of
/// it: the history, and where the weights came from.
template <typename Model, typename MakeBatch, typename Logits, typename Validate>
nlohmann::json run_training(Model& model, const GeneratorData& data,
                            const TransformerTrainingOptions& options, const Monitor& monitor,
                            MakeBatch make_batch, Logits logits_of, Validate validate) {
  const nlohmann::json start = start_from(*model, options.start);
  nlohmann::json identity = run_identity(model->config(), data, options);
  if (!start.empty()) identity["start"] = start;
  Trainer trainer(*model, options.trainer, identity);
  BatchSchedule schedule(data.train.clips, options.batch, options.trainer.seed);
  if (!data.val.clips.empty()) {
    trainer.set_validation(options.validate_every, [&](int64_t) { return validate(); });
  }
  trainer.run(
      [&](int64_t step) {
        const TransformerBatch batch = make_batch(schedule.at_step(step), step);
        return step_result(token_loss(logits_of(batch), batch.targets));
      },
      monitor);
  nlohmann::json record = {{"history", trainer.history()}};
  if (!start.empty()) record["start"] = start;
  return record;
}

}  // namespace

nlohmann::json options_document(const TransformerTrainingOptions& options) {
  return {{"batch", options.batch},
          {"noise_hits", options.noise_hits},
          {"unfamiliar_hits", options.unfamiliar_hits},
          {"text_drop", options.text_drop},
          {"history_corruption", options.history_corruption}};
}

nn::ModelStage train_masked(generator::MaskedConfig config, const GeneratorData& data,
                            const TransformerTrainingOptions& options, const Monitor& monitor) {
  check_training_data(data);
  fit_config(config, data);
  torch::manual_seed(mix_seed(options.trainer.seed, 0x6d61736bu));
  generator::MaskedTransformer model(config);
  const nlohmann::json record = run_training(
      model, data, options, monitor,
      [&](const std::vector<size_t>& members, int64_t step) {
        return masked_batch(data, members, config, options, step);
      },
      [&](const TransformerBatch& batch) {
        return model->forward(batch.tokens, model->prepare(batch.condition), batch.frame_mask);
      },
      [&] { return validate_masked(model, data, options); });
  nn::ModelStage stage = generator::masked_stage(model);
  stage.config.update(record);
  return stage;
}

nn::ModelStage train_residual(generator::ResidualConfig config, const GeneratorData& data,
                              const TransformerTrainingOptions& options, const Monitor& monitor) {
  check_training_data(data);
  if (data.levels < 2) {
    throw Error(
        "training the residual transformer: the tokenizer has one level only; it is of "
        "no use there");
  }
  fit_config(config, data);
  config.levels = data.levels;
  torch::manual_seed(mix_seed(options.trainer.seed, 0x72657369u));
  generator::ResidualTransformer model(config);
  const nlohmann::json record = run_training(
      model, data, options, monitor,
      [&](const std::vector<size_t>& members, int64_t step) {
        return residual_batch(data, members, config, options, step);
      },
      [&](const TransformerBatch& batch) {
        return model->forward(batch.tokens, batch.level, model->prepare(batch.condition),
                              batch.frame_mask);
      },
      [&] { return validate_residual(model, data, options); });
  nn::ModelStage stage = generator::residual_stage(model);
  stage.config.update(record);
  return stage;
}

}  // namespace remomask::training
