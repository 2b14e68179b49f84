#include "training/evaluator_training.h"

#include <torch/utils.h>

#include <algorithm>
#include <set>

#include "base/random.h"
#include "evaluation/evaluator_network.h"
#include "evaluation/evaluator_quality.h"
#include "evaluation/word_classes.h"
#include "remomask/error.h"
#include "text/caption.h"
#include "training/training_batches.h"

namespace remomask::training {

namespace {

constexpr uint64_t kWindowStream = 0x77696e, kPairStream = 0x706169;
constexpr int kValidationDraws = 4;
constexpr int64_t kValidationBatch = 32;
constexpr double kCodePenalty = 0.001, kSmoothPenalty = 0.001;

std::vector<db::TrainingClip> evaluator_clips(const std::vector<db::TrainingClip>& clips) {
  std::vector<db::TrainingClip> result = captioned_clips(clips);
  std::erase_if(result, [](const db::TrainingClip& clip) {
    return clip.features.frames < evaluation::kFramesPerMovement;
  });
  return result;
}

/// Stage 1: the movement encoder of a network with a decoder.
class MovementAutoencoder : public torch::nn::Module {
 public:
  explicit MovementAutoencoder(evaluation::EvaluatorNetwork& network)
      : encoder_(register_module("encoder", network->movement_encoder())),
        decoder_(register_module(
            "decoder",
            evaluation::MovementDecoder(network->config().movement_width, network->columns()))) {}

  at::Tensor loss(const at::Tensor& motion) {
    const at::Tensor codes =
        encoder_(motion.slice(2, 0, motion.size(2) - evaluation::kContactColumns));
    const at::Tensor steps = codes.slice(1, 1) - codes.slice(1, 0, codes.size(1) - 1);
    return (decoder_(codes) - motion).abs().mean() + kCodePenalty * codes.abs().mean() +
           kSmoothPenalty * steps.abs().mean();
  }

 private:
  evaluation::MovementEncoder encoder_;
  evaluation::MovementDecoder decoder_;
};

at::Tensor random_windows(const evaluation::EvaluatorNetwork& network,
                          const std::vector<const db::TrainingClip*>& clips,
                          const EvaluatorTrainingOptions& options, int64_t step) {
  CounterRandom random(options.movement.seed, mix_seed(kWindowStream, static_cast<uint64_t>(step)));
  std::vector<evaluation::EvaluatorCrop> crops;
  const int window = static_cast<int>(options.window);
  for (int64_t i = 0; i < options.movement_batch; ++i) {
    const motion::Features& features = clips[random.below(clips.size())]->features;
    const auto starts = static_cast<size_t>(features.frames - window + 1);
    crops.push_back({&features, static_cast<int>(random.below(starts)), window});
  }
  // Without the zeros that follow a motion's end.
  return network->batch(crops).features.slice(1, 0, window);
}

void train_movement_encoder(evaluation::EvaluatorNetwork& network,
                            const std::vector<db::TrainingClip>& clips,
                            const EvaluatorTrainingOptions& options, const nlohmann::json& identity,
                            const Monitor& monitor) {
  std::vector<const db::TrainingClip*> usable;
  for (const db::TrainingClip& clip : clips) {
    if (clip.features.frames >= options.window) usable.push_back(&clip);
  }
  if (usable.empty()) {
    throw Error("no training clip has the " + std::to_string(options.window) +
                " frames that the evaluator's movement encoder is trained on");
  }
  TrainerOptions trainer_options = options.movement;
  if (!options.trainer.checkpoint_path.empty()) {
    trainer_options.checkpoint_path = options.trainer.checkpoint_path + ".movement";
    trainer_options.checkpoint_seconds = options.trainer.checkpoint_seconds;
  }
  MovementAutoencoder autoencoder(network);
  Trainer trainer(autoencoder, trainer_options, identity);
  trainer.run(
      [&](int64_t step) {
        return StepResult{autoencoder.loss(random_windows(network, usable, options, step)), {}};
      },
      monitor);
}

/// Stage 2, with the best state so far in buffers: they are part of the
/// checkpoint, so that a resumed run keeps it.
class EvaluatorSelection : public torch::nn::Module {
 public:
  explicit EvaluatorSelection(evaluation::EvaluatorNetwork& network)
      : network_(register_module("network", network)),
        best_figure_(register_buffer("best_figure", torch::full({1}, -1, torch::kDouble))),
        best_step_(register_buffer("best_step", torch::zeros({1}, torch::kLong))) {
    for (const auto& [name, tensor] : nn::module_tensors(*network_)) {
      std::string flat = name;
      std::replace(flat.begin(), flat.end(), '.', '/');  // names of buffers hold no dot
      best_[name] = register_buffer("best/" + flat, tensor);
    }
  }

  void offer(double figure, int64_t step) {
    if (!(figure > best_figure_.item<double>())) return;  // also for no number
    best_figure_.fill_(figure);
    best_step_.fill_(step);
    for (const auto& [name, tensor] : nn::module_tensors(*network_)) best_.at(name).copy_(tensor);
  }

  bool has_best() const { return best_figure_.item<double>() >= 0; }
  int64_t best_step() const { return best_step_.item<int64_t>(); }
  const nn::TensorMap& best() const { return best_; }

 private:
  evaluation::EvaluatorNetwork network_;
  at::Tensor best_figure_, best_step_;
  nn::TensorMap best_;
};

at::Tensor shifted_pairs(int64_t batch, int64_t shifts, CounterRandom& random) {
  at::Tensor pairs = torch::zeros({batch, batch}, torch::kBool);
  if (batch < 2) return pairs;
  const std::vector<size_t> order = random.permutation(static_cast<size_t>(batch - 1));
  const int64_t used = std::min(shifts, batch - 1);
  for (int64_t s = 0; s < used; ++s) {
    const auto shift = static_cast<int64_t>(order[static_cast<size_t>(s)]) + 1;
    for (int64_t i = 0; i < batch; ++i) pairs.index_put_({i, (i + shift) % batch}, true);
  }
  return pairs;
}

/// Draws the batches of stage 2: a function of seed and step alone.
class PairSource {
 public:
  PairSource(const std::vector<db::TrainingClip>& clips, const EvaluatorTrainingOptions& options)
      : clips_(clips), options_(options), batches_(clips, options.batch, options.trainer.seed) {}

  StepResult step(evaluation::EvaluatorNetwork& network, int64_t step) {
    CounterRandom random(options_.trainer.seed, mix_seed(kPairStream, static_cast<uint64_t>(step)));
    std::vector<const db::TrainingClip*> chosen;
    std::vector<std::string> captions;
    std::vector<evaluation::EvaluatorCrop> crops;
    for (const size_t index : batches_.at_step(step)) {
      const db::TrainingClip& clip = clips_[index];
      chosen.push_back(&clip);
      captions.push_back(clip.captions[random.below(clip.captions.size())]);
      crops.push_back(crop(clip.features, random));
    }
    const at::Tensor mismatched =
        may_mismatch(chosen, captions)
            .logical_and(
                shifted_pairs(static_cast<int64_t>(chosen.size()), options_.shifts, random));
    evaluation::WordBatch words = network->words().encode(captions);
    drop_words(words, random);
    const at::Tensor text = network->embed_text(words),
                     motion = network->embed_motion(network->batch(crops));
    const at::Tensor loss = evaluator_loss(text, motion, mismatched, options_.margin);
    return {loss, {{"matched", evaluation::matching_distance(text.detach(), motion.detach())}}};
  }

 private:
  evaluation::EvaluatorCrop crop(const motion::Features& features, CounterRandom& random) const {
    const auto share = random.uniform(options_.min_crop, 1);
    const int frames = std::max(static_cast<int>(evaluation::kFramesPerMovement),
                                static_cast<int>(share * features.frames));
    const auto starts = static_cast<size_t>(features.frames - frames + 1);
    return {&features, static_cast<int>(random.below(starts)), frames};
  }

  void drop_words(evaluation::WordBatch& words, CounterRandom& random) const {
    int64_t* ids = words.ids.data_ptr<int64_t>();
    int64_t* classes = words.classes.data_ptr<int64_t>();
    for (int64_t i = 0; i < words.ids.numel(); ++i) {
      if (random.uniform() >= options_.word_drop || ids[i] <= evaluation::EvaluatorWords::kUnknown)
        continue;
      ids[i] = evaluation::EvaluatorWords::kUnknown;
      classes[i] = static_cast<int64_t>(evaluation::WordClass::other);
    }
  }

  const std::vector<db::TrainingClip>& clips_;
  const EvaluatorTrainingOptions& options_;
  EpochBatches batches_;
};

nn::ModelStage evaluator_stage(const evaluation::EvaluatorConfig& config,
                               const nn::TensorMap& tensors) {
  return {"evaluator", config, tensors};
}

std::map<std::string, double> validate_evaluator(const evaluation::Evaluator& evaluator,
                                                 const std::vector<db::TrainingClip>& val,
                                                 uint64_t seed) {
  const auto pairs = evaluation::real_pairs(evaluator, val, evaluation::DistinctBy::captions,
                                            kValidationDraws, seed);
  const std::set<evaluation::BatchKeys> captions(pairs.front().keys.begin(),
                                                 pairs.front().keys.end());
  evaluation::GenerationFigureOptions options;
  options.draws = kValidationDraws;
  options.batch = std::min(kValidationBatch, static_cast<int64_t>(captions.size()));
  const evaluation::GenerationFigures figures = measure_pairs(pairs, options);
  return {{"top1", figures.r_precision[0].mean},
          {"top2", figures.r_precision[1].mean},
          {"top3", figures.r_precision[2].mean}};
}

nlohmann::json evaluator_run_identity(const evaluation::EvaluatorConfig& config,
                                      const std::vector<db::TrainingClip>& train,
                                      const std::vector<db::TrainingClip>& val,
                                      const EvaluatorTrainingOptions& options) {
  return {{"config", config},
          {"train", db::training_set_identity(train)},
          {"val", db::training_set_identity(val)},
          {"movement_steps", options.movement.steps},
          {"movement_batch", options.movement_batch},
          {"window", options.window},
          {"batch", options.batch},
          {"margin", options.margin},
          {"shifts", options.shifts},
          {"least_crop", options.min_crop},  // the key of the files there are: it is hashed
          {"word_drop", options.word_drop},
          {"validation_every", options.validation_every}};
}

}  // namespace

EvaluatorTrainingOptions::EvaluatorTrainingOptions(ModelSize size) {
  movement.stage_name = "evaluator movement";
  movement.steps = 600;
  movement.learning_rate = 1e-3;
  movement.warmup_steps = 100;
  movement.weight_decay = 0;
  movement.ema_decay = 0.99;
  trainer.stage_name = "evaluator";
  trainer.steps = 2000;
  trainer.learning_rate = 1e-3;
  trainer.warmup_steps = 100;
  trainer.weight_decay = 0.01;
  trainer.ema_decay = 0.99;
  if (size == ModelSize::tiny) {
    movement.steps = 100;
    movement_batch = 32;
    trainer.steps = 200;
    movement.warmup_steps = trainer.warmup_steps = 10;
    movement.ema_decay = trainer.ema_decay = 0.9;
    trainer.learning_rate = 3e-3;
    batch = 32;
    shifts = 31;
    validation_every = 50;
  } else if (size == ModelSize::paper) {
    movement.steps = 100000;
    movement.learning_rate = trainer.learning_rate = 1e-4;
    trainer.steps = 30000;
    trainer.clip_norm = 0.5;
    trainer.weight_decay = 0;
    movement.ema_decay = trainer.ema_decay = 0;
    shifts = 1;
    word_drop = 0;
    validation_every = 400;
  }
}

at::Tensor may_mismatch(const std::vector<const db::TrainingClip*>& clips,
                        const std::vector<std::string>& captions) {
  const auto count = static_cast<int64_t>(clips.size());
  at::Tensor result = torch::zeros({count, count}, torch::kBool);
  std::vector<std::string> texts;
  for (const std::string& caption : captions) texts.push_back(text::normalise_caption(caption));
  bool* pairs = result.data_ptr<bool>();
  for (size_t i = 0; i < clips.size(); ++i) {
    for (size_t j = 0; j < clips.size(); ++j) {
      const bool alike = clips[i]->group == clips[j]->group || texts[i] == texts[j] ||
                         (!clips[i]->meaning.empty() && clips[i]->meaning == clips[j]->meaning);
      pairs[i * clips.size() + j] = !alike;
    }
  }
  return result;
}

at::Tensor evaluator_loss(const at::Tensor& text, const at::Tensor& motion,
                          const at::Tensor& mismatched, double margin) {
  const at::Tensor squares = (text.unsqueeze(1) - motion.unsqueeze(0)).square().sum(2);  // [B, B]
  const at::Tensor matched = squares.diagonal().mean();
  const double count = static_cast<double>(mismatched.sum().item<int64_t>());
  if (count == 0) return matched;
  // The gradient of a root at zero is not finite.
  const at::Tensor distances = (squares + 1e-12).sqrt();
  const at::Tensor lacking = (margin - distances).clamp_min(0).square();
  return matched + (lacking * mismatched).sum() / count;
}

nn::ModelStage train_evaluator(const std::vector<db::TrainingClip>& train,
                               const std::vector<db::TrainingClip>& val,
                               evaluation::EvaluatorConfig config,
                               const EvaluatorTrainingOptions& options, const Monitor& monitor) {
  const std::vector<db::TrainingClip> clips = evaluator_clips(train),
                                      val_clips = evaluator_clips(val);
  if (clips.size() < 2) {
    throw Error("the evaluator needs at least 2 training clips with captions, there are " +
                std::to_string(clips.size()) + "; import a captions file");
  }
  std::vector<std::string> captions;
  std::vector<const motion::Features*> features;
  for (const db::TrainingClip& clip : clips) {
    captions.insert(captions.end(), clip.captions.begin(), clip.captions.end());
    features.push_back(&clip.features);
  }
  config.vocabulary = evaluation::evaluator_vocabulary(captions);

  torch::manual_seed(options.trainer.seed);
  evaluation::EvaluatorNetwork network(config);
  network->set_statistics(features);
  const nlohmann::json identity = evaluator_run_identity(config, clips, val_clips, options);
  train_movement_encoder(network, clips, options, identity, monitor);
  for (at::Tensor& parameter : network->movement_encoder()->parameters()) {
    parameter.requires_grad_(false);
  }

  EvaluatorSelection selection(network);
  Trainer trainer(selection, options.trainer, identity);
  if (!val_clips.empty()) {
    trainer.set_validation(options.validation_every, [&](int64_t step) {
      const evaluation::Evaluator evaluator(evaluator_stage(config, nn::module_tensors(*network)));
      auto figures = validate_evaluator(evaluator, val_clips, options.trainer.seed);
      selection.offer((figures["top1"] + figures["top2"] + figures["top3"]) / 3, step);
      return figures;
    });
  }
  PairSource source(clips, options);
  trainer.run(
      [&](int64_t step) {
        network->movement_encoder()->eval();  // frozen, without dropout
        return source.step(network, step);
      },
      monitor);

  nn::ModelStage stage = evaluator_stage(
      config, selection.has_best() ? selection.best() : nn::module_tensors(*network));
  stage.config["history"] = trainer.history();
  if (selection.has_best()) stage.config["selected_step"] = selection.best_step();
  return stage;
}

}  // namespace remomask::training
