#include "training/retriever_training.h"

#include <torch/utils.h>

#include <algorithm>
#include <functional>

#include "base/hash.h"
#include "base/random.h"
#include "evaluation/retrieval_metrics.h"
#include "remomask/error.h"
#include "text/caption.h"
#include "training/caption_states.h"
#include "training/momentum.h"
#include "training/start_weights.h"
#include "training/training_batches.h"

namespace remomask::training {

namespace {

constexpr uint64_t kCropStream = 0x63726f70;

int64_t text_identity(const std::string& text) {
  return static_cast<int64_t>(std::stoull(content_hash(text).substr(0, 16), nullptr, 16));
}

/// Of what the labels say, or of the group where they are silent.
int64_t meaning_identity(const db::TrainingClip& clip) {
  return text_identity(clip.meaning.empty() ? "group " + std::to_string(clip.group)
                                            : "meaning " + clip.meaning);
}

std::vector<std::string> all_captions(const std::vector<db::TrainingClip>& clips) {
  std::vector<std::string> captions;
  for (const db::TrainingClip& clip : clips) {
    captions.insert(captions.end(), clip.captions.begin(), clip.captions.end());
  }
  return captions;
}

/// Draws the batches of a run: a function of seed and step alone.
class BatchSource {
 public:
  BatchSource(const std::vector<db::TrainingClip>& clips, const retriever::RetrieverConfig& config,
              const RetrieverTrainingOptions& options, const encoders::TextTower& tower,
              const Monitor& monitor)
      : clips_(clips),
        config_(config),
        options_(options),
        states_(tower, all_captions(clips), config.tuned_text_layers, monitor),
        batches_(clips, options.batch, options.trainer.seed) {}

  PairBatch batch(int64_t step, retriever::RetrieverModel& model) {
    const std::vector<size_t>& chosen = batches_.at_step(step);
    std::vector<std::string> captions;
    std::vector<retriever::MotionCrop> online, whole;
    std::vector<int64_t> groups, texts, meanings;
    CounterRandom random(options_.trainer.seed, mix_seed(kCropStream, static_cast<uint64_t>(step)));
    for (const size_t index : chosen) {
      const db::TrainingClip& clip = clips_[index];
      captions.push_back(clip.captions[random.below(clip.captions.size())]);
      online.push_back(retriever::random_crop(clip.features, options_.min_crop, options_.patch_keep,
                                              config_.patch, random));
      whole.push_back({&clip.features, online.back().first, online.back().frames, {}});
      groups.push_back(clip.group);
      texts.push_back(text_identity(text::normalise_caption(captions.back())));
      meanings.push_back(meaning_identity(clip));
    }
    retriever::MotionEncoder& encoder = model.motion_encoder();
    const encoders::TokenBatch tokens = model.text_tower().tokenize(captions);
    return {tokens,
            states_.states(captions, tokens),
            encoder.patches(online),
            encoder.patches(whole),
            {torch::tensor(groups, torch::kLong), torch::tensor(texts, torch::kLong),
             torch::tensor(meanings, torch::kLong)}};
  }

 private:
  const std::vector<db::TrainingClip>& clips_;
  const retriever::RetrieverConfig& config_;
  const RetrieverTrainingOptions& options_;
  CaptionStates states_;
  EpochBatches batches_;
};

nn::ModelStage retriever_stage(BmmModel& model, const retriever::RetrieverConfig& config) {
  return {"retriever", config, nn::module_tensors(model.online())};
}

}  // namespace

RetrieverTrainingOptions::RetrieverTrainingOptions(ModelSize size) {
  trainer.stage_name = "retriever";
  trainer.steps = 1800;
  trainer.learning_rate = 1e-3;
  trainer.warmup_steps = 100;
  trainer.weight_decay = 0.01;
  trainer.ema_decay = 0.995;
  if (size == ModelSize::tiny) {
    batch = 32;
    queue_size = 256;
    trainer.steps = 200;
    trainer.learning_rate = 2e-3;
    trainer.warmup_steps = 20;
    trainer.ema_decay = 0.9;
  } else if (size == ModelSize::paper) {
    batch = 128;
    queue_size = 65536;
    patch_keep = 1;
    trainer.steps = 40000;
    trainer.learning_rate = 1e-4;
    trainer.warmup_steps = 1000;
    trainer.ema_decay = 0.999;
  }
}

nlohmann::json options_document(const RetrieverTrainingOptions& options) {
  return {{"batch", options.batch},
          {"queues", retriever::queues_name(options.queues)},
          {"queue_size", options.queue_size},
          {"momentum", options.momentum},
          {"temperature", options.temperature},
          {"part_weight", options.part_weight},
          {"least_crop", options.min_crop},  // the key of the files there are: it is hashed
          {"patch_keep", options.patch_keep},
          {"word_drop", options.word_drop},
          {"same_meaning_weight", options.same_meaning_weight}};
}

nn::ModelStage train_retriever(const std::vector<db::TrainingClip>& train,
                               const std::vector<db::TrainingClip>& val,
                               const std::shared_ptr<const encoders::SentenceEncoder>& words,
                               retriever::RetrieverConfig config,
                               const RetrieverTrainingOptions& options, const Monitor& monitor) {
  const std::vector<db::TrainingClip> clips = captioned_clips(train),
                                      val_clips = captioned_clips(val);
  if (clips.size() < 2) {
    throw Error("the retriever needs at least 2 training clips with captions, there are " +
                std::to_string(clips.size()) + "; import a captions file");
  }
  config.text_encoder = words->tower_hash();
  config.text_encoder_width = words->width();

  torch::manual_seed(options.trainer.seed);
  BmmModel model(config, words->tower(), options.queues, options.queue_size, options.momentum,
                 options.temperature, options.same_meaning_weight);
  std::vector<const motion::Features*> features;
  for (const db::TrainingClip& clip : clips) features.push_back(&clip.features);
  nlohmann::json start = start_from(model.online(), options.start);
  model.online().motion_encoder().set_statistics(features);
  update_twin(model.twin(), model.online(), 0);

  nlohmann::json identity = options_document(options);
  identity["config"] = config;
  if (!start.empty()) identity["start"] = start;
  identity["train"] = db::training_set_identity(clips);
  Trainer trainer(model, options.trainer, identity);
  if (!val_clips.empty()) {
    trainer.set_validation(options.validation_every, [&](int64_t) {
      const retriever::Retriever retriever(retriever_stage(model, config), words);
      evaluation::RetrievalOptions measure;
      measure.protocols = {evaluation::RetrievalProtocol::duplicates};
      measure.bootstrap.resamples = 0;
      const evaluation::RetrievalEvaluation evaluation =
          evaluation::evaluate_retrieval(retriever, val_clips, measure);
      const evaluation::RetrievalSubset& all = evaluation.protocols.front().subsets.front();
      const evaluation::RecallFigures &t2m = all.text_to_motion.recall,
                                      &m2t = all.motion_to_text.recall;
      return std::map<std::string, double>{{"t2m_R@1", t2m.recall.front()},
                                           {"t2m_R@10", t2m.recall.back()},
                                           {"m2t_R@1", m2t.recall.front()},
                                           {"m2t_R@10", m2t.recall.back()}};
    });
  }
  trainer.set_after_step([&](int64_t) { model.after_step(); });
  BatchSource source(clips, config, options, *words->tower(), monitor);
  trainer.run(
      [&](int64_t step) {
        const BmmLosses losses =
            model.loss(source.batch(step, model.online()), options.part_weight, options.word_drop);
        return StepResult{losses.total,
                          {{"m2t", losses.motion_to_text},
                           {"t2m", losses.text_to_motion},
                           {"parts", losses.parts},
                           {"temperature", 1 / model.scale().item<double>()}}};
      },
      monitor);

  nn::ModelStage stage = retriever_stage(model, config);
  stage.config["history"] = trainer.history();
  if (!start.empty()) stage.config["start"] = start;
  return stage;
}

}  // namespace remomask::training
