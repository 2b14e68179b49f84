#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "db/training_set.h"
#include "encoders/sentence_encoder.h"
#include "nn/model_file.h"
#include "remomask/progress.h"
#include "retriever/config.h"
#include "training/trainer.h"

namespace remomask::training {

struct RetrieverTrainingOptions {
  TrainerOptions trainer;
  int64_t batch = 64;
  retriever::Queues queues = retriever::Queues::both;
  int64_t queue_size = 2048;
  double momentum = 0.99;
  double temperature = 0.07;  ///< at the start; it is learnt
  double part_weight = 0.1;   ///< of the part-level terms
  double min_crop = 0.7;      ///< shortest random crop, share of the clip
  double patch_keep = 0.5;    ///< share of the patches that the online encoder sees
  double word_drop = 0.1;     ///< share of the words hidden from the online model
  /// What a clip weighs as a negative of another one whose labels say the same
  /// content in the same style (neither group nor caption gives such repetitions
  /// away); 0: nothing, 1: as much as any other clip.
  double same_meaning_weight = 1;
  int64_t validation_every = 200;
  /// A retriever whose weights the training goes on from, where their shapes fit.
  std::optional<nn::ModelStage> start;
  /// Defaults for a network of this size: queues and a run that fit it.
  explicit RetrieverTrainingOptions(ModelSize size = ModelSize::base);
};

/// What decides what is learnt, but for TrainerOptions: identifies a run.
nlohmann::json options_document(const RetrieverTrainingOptions& options);

/// Trains text reader and motion encoder together by bidirectional momentum contrast over the
/// frozen states of the sentence encoder `words`, and returns ModelStage "retriever" (online
/// weights averaged over the run; twins and queues stay in the checkpoint). Clips without captions
/// are left out. Val figures (R@1, R@10 both ways) go to config["history"]. Throws Error when
/// nothing can be trained.
nn::ModelStage train_retriever(const std::vector<db::TrainingClip>& train,
                               const std::vector<db::TrainingClip>& val,
                               const std::shared_ptr<const encoders::SentenceEncoder>& words,
                               retriever::RetrieverConfig config,
                               const RetrieverTrainingOptions& options, const Monitor& monitor);

}  // namespace remomask::training
