#include "retriever/training.h"

#include <torch/utils.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <set>

#include "base/error.h"
#include "base/hash.h"
#include "base/random.h"
#include "retriever/momentum.h"
#include "retriever/retrieval_metrics.h"
#include "text/caption.h"

namespace remomask {

namespace {

constexpr uint64_t kEpochStream = 0x65706f6368, kCropStream = 0x63726f70;
/// Batches that are sorted by length together.
constexpr size_t kBatchesByLength = 8;

int64_t text_identity(const std::string& text) {
  return static_cast<int64_t>(std::stoull(content_hash(text).substr(0, 16), nullptr, 16));
}

/// Of what the labels say, or of the group where they are silent.
int64_t meaning_identity(const TrainingClip& clip) {
  return text_identity(clip.meaning.empty() ? "group " + std::to_string(clip.group)
                                            : "meaning " + clip.meaning);
}

/// What tells one training set from another, for the checkpoint.
std::string set_identity(const std::vector<TrainingClip>& clips) {
  std::string text;
  for (const TrainingClip& clip : clips) {
    text += clip.name + '\t' + std::to_string(clip.features.frames) + '\t';
    for (const std::string& caption : clip.captions) text += caption + '\t';
    text += clip.meaning + '\n';
  }
  return content_hash(text);
}

std::vector<TrainingClip> with_captions(const std::vector<TrainingClip>& clips) {
  std::vector<TrainingClip> result;
  for (const TrainingClip& clip : clips) {
    TrainingClip kept = clip;
    std::erase_if(kept.captions,
                  [](const std::string& text) { return normalise_caption(text).empty(); });
    if (!kept.captions.empty()) result.push_back(std::move(kept));
  }
  return result;
}

nlohmann::json fresh_text_tower(const std::vector<TrainingClip>& clips, const std::string& preset) {
  TextEncoderConfig config = text_encoder_preset(preset);
  std::vector<std::string> captions;
  for (const TrainingClip& clip : clips) {
    for (const std::string& caption : clip.captions) captions.push_back(normalise_caption(caption));
  }
  config.vocabulary = train_wordpiece(captions, config.vocabulary_size);
  return config;
}

/// Draws the batches of a run: a function of seed and step alone.
class BatchSource {
 public:
  BatchSource(const std::vector<TrainingClip>& clips, const RetrieverConfig& config,
              const RetrieverTrainingOptions& options)
      : clips_(clips), config_(config), options_(options) {}

  PairBatch batch(int64_t step, RetrieverModel& model) {
    const std::vector<size_t>& chosen = members(static_cast<uint64_t>(step));
    std::vector<std::string> captions;
    std::vector<MotionCrop> online, whole;
    std::vector<int64_t> groups, texts, meanings;
    CounterRandom random(options_.trainer.seed, mix_seed(kCropStream, static_cast<uint64_t>(step)));
    for (const size_t index : chosen) {
      const TrainingClip& clip = clips_[index];
      captions.push_back(clip.captions[random.below(clip.captions.size())]);
      online.push_back(random_crop(clip.features, options_.least_crop, options_.patch_keep,
                                   config_.patch, random));
      whole.push_back({&clip.features, online.back().first, online.back().frames, {}});
      groups.push_back(clip.group);
      texts.push_back(text_identity(normalise_caption(captions.back())));
      meanings.push_back(meaning_identity(clip));
    }
    MotionEncoder& encoder = model.motion_encoder();
    return {model.text_tower().tokenize(captions),
            encoder.patches(online),
            encoder.patches(whole),
            {torch::tensor(groups, torch::kLong), torch::tensor(texts, torch::kLong),
             torch::tensor(meanings, torch::kLong)}};
  }

 private:
  const std::vector<size_t>& members(uint64_t step) {
    if (batches_.empty()) load_epoch(0);
    const uint64_t epoch = step / batches_.size();  // every epoch has equally many batches
    if (epoch != epoch_) load_epoch(epoch);
    return batches_[step % batches_.size()];
  }

  void load_epoch(uint64_t epoch) {
    batches_ = epoch_batches(clips_, options_.batch, options_.trainer.seed, epoch);
    epoch_ = epoch;
  }

  const std::vector<TrainingClip>& clips_;
  const RetrieverConfig& config_;
  const RetrieverTrainingOptions& options_;
  std::vector<std::vector<size_t>> batches_;
  uint64_t epoch_ = 0;
};

ModelStage retriever_stage(BmmModel& model, const RetrieverConfig& config) {
  return {"retriever", config, module_tensors(model.online())};
}

}  // namespace

RetrieverTrainingOptions::RetrieverTrainingOptions(const std::string& preset) {
  trainer.stage_name = "retriever";
  trainer.steps = 1800;
  trainer.learning_rate = 1e-3;
  trainer.warmup_steps = 100;
  trainer.weight_decay = 0.01;
  trainer.ema_decay = 0.995;
  if (preset == "tiny") {
    batch = 32;
    queue_size = 256;
    trainer.steps = 200;
    trainer.learning_rate = 2e-3;
    trainer.warmup_steps = 20;
    trainer.ema_decay = 0.9;
  } else if (preset == "paper") {
    batch = 128;
    queue_size = 65536;
    patch_keep = 1;
    trainer.steps = 40000;
    trainer.learning_rate = 1e-4;
    trainer.warmup_steps = 1000;
    trainer.ema_decay = 0.999;
  }
}

std::vector<std::vector<size_t>> epoch_batches(const std::vector<TrainingClip>& clips,
                                               int64_t batch, uint64_t seed, uint64_t epoch) {
  CounterRandom random(seed, mix_seed(kEpochStream, epoch));
  std::vector<size_t> order = random.permutation(clips.size());
  const size_t size = std::min(static_cast<size_t>(batch), clips.size());
  const size_t count = size == 0 ? 0 : clips.size() / size;
  for (size_t first = 0; first < order.size(); first += kBatchesByLength * size) {
    const size_t last = std::min(order.size(), first + kBatchesByLength * size);
    std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(first),
                     order.begin() + static_cast<std::ptrdiff_t>(last), [&](size_t a, size_t b) {
                       return clips[a].features.frames < clips[b].features.frames;
                     });
  }
  std::vector<std::vector<size_t>> batches;
  std::deque<size_t> waiting(order.begin(), order.end());
  while (batches.size() < count) {
    std::vector<size_t> members, deferred;
    std::set<int> groups;
    while (members.size() < size && !waiting.empty()) {
      const size_t index = waiting.front();
      waiting.pop_front();
      const bool fresh = groups.insert(clips[index].group).second;
      (fresh ? members : deferred).push_back(index);
    }
    // Groups are used up: the rest must repeat them.
    while (members.size() < size) {
      members.push_back(deferred.back());
      deferred.pop_back();
    }
    waiting.insert(waiting.begin(), deferred.begin(), deferred.end());
    batches.push_back(std::move(members));
  }
  std::vector<std::vector<size_t>> shuffled;
  for (const size_t i : random.permutation(batches.size())) shuffled.push_back(batches[i]);
  return shuffled;
}

ModelStage train_retriever(const std::vector<TrainingClip>& train,
                           const std::vector<TrainingClip>& val,
                           const std::optional<ModelStage>& text_stage, RetrieverConfig config,
                           const RetrieverTrainingOptions& options, const Monitor& monitor) {
  const std::vector<TrainingClip> clips = with_captions(train), val_clips = with_captions(val);
  if (clips.size() < 2) {
    throw Error("the retriever needs at least 2 training clips with captions, there are " +
                std::to_string(clips.size()) + "; import a captions file");
  }
  config.text_tower = text_stage ? text_stage->config : fresh_text_tower(clips, config.preset);
  config.text_tower.erase("history");
  config.text_tower.erase("recipe");

  torch::manual_seed(options.trainer.seed);
  BmmModel model(config, options.queues, options.queue_size, options.momentum, options.temperature,
                 options.same_meaning_weight);
  if (text_stage) {
    load_module_tensors(model.online().text_tower(), text_stage->tensors, "text stage");
  }
  std::vector<const Features*> features;
  for (const TrainingClip& clip : clips) features.push_back(&clip.features);
  model.online().motion_encoder().set_statistics(features);
  update_twin(model.twin(), model.online(), 0);

  const nlohmann::json identity = {{"config", config},
                                   {"train", set_identity(clips)},
                                   {"batch", options.batch},
                                   {"queues", queues_name(options.queues)},
                                   {"queue_size", options.queue_size},
                                   {"momentum", options.momentum},
                                   {"temperature", options.temperature},
                                   {"part_weight", options.part_weight},
                                   {"least_crop", options.least_crop},
                                   {"patch_keep", options.patch_keep},
                                   {"word_drop", options.word_drop},
                                   {"same_meaning_weight", options.same_meaning_weight},
                                   {"text", text_stage ? stage_hash(*text_stage) : ""}};
  Trainer trainer(model, options.trainer, identity);
  if (!val_clips.empty()) {
    trainer.set_validation(options.validation_every, [&](int64_t) {
      const Retriever retriever(retriever_stage(model, config));
      RetrievalOptions measure;
      measure.protocols = {RetrievalProtocol::duplicates};
      measure.bootstrap.resamples = 0;
      const RetrievalEvaluation evaluation = evaluate_retrieval(retriever, val_clips, measure);
      const RetrievalSubset& all = evaluation.protocols.front().subsets.front();
      const RecallFigures &t2m = all.text_to_motion.recall, &m2t = all.motion_to_text.recall;
      return std::map<std::string, double>{{"t2m_R@1", t2m.recall.front()},
                                           {"t2m_R@10", t2m.recall.back()},
                                           {"m2t_R@1", m2t.recall.front()},
                                           {"m2t_R@10", m2t.recall.back()}};
    });
  }
  trainer.set_after_step([&](int64_t) { model.after_step(); });
  BatchSource source(clips, config, options);
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

  ModelStage stage = retriever_stage(model, config);
  stage.config["history"] = trainer.history();
  return stage;
}

}  // namespace remomask
