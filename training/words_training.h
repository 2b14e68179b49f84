#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "db/database.h"
#include "encoders/low_rank_adapter.h"
#include "nn/model_file.h"
#include "remomask/progress.h"
#include "training/trainer.h"

namespace remomask::training {

struct WordsTrainingOptions {
  TrainerOptions trainer;  ///< steps, rate, seed, checkpoint
  encoders::AdapterConfig adapter;
  int64_t batch = 48;          ///< classes a step, two captions of each
  double temperature = 0.05;   ///< of the softmax over the captions of a batch
  int64_t general_texts = 24;  ///< texts a step whose likeness must stay as it was
  double general_weight = 20;  ///< of the mean square by which their cosines change
  int64_t validate_every = 100;

  WordsTrainingOptions() {
    trainer.stage_name = "words";
    trainer.steps = 400;
    trainer.learning_rate = 1e-3;
    trainer.warmup_steps = 40;
    trainer.weight_decay = 0;
    trainer.ema_decay = 0.98;
  }
};

/// Captions that say the same: clips with the same actions in the same style.
struct CaptionClass {
  std::set<std::string> actions;
  std::string style;
  std::vector<std::vector<std::string>> clips;  ///< captions of each clip
  std::vector<std::string> captions;            ///< all of them, each once
};

/// The classes of the clips of a split that have at least two captions, by actions and style. Clips
/// without labels "actions" and "style" are a class each.
std::vector<CaptionClass> caption_classes(const std::vector<db::Clip>& clips,
                                          const std::string& split);

/// Whether what one class shows is also shown by the other, so that they are no negatives of each
/// other: all actions of one are among those of the other, in the same style or in none.
bool may_mean_the_same(const CaptionClass& left, const CaptionClass& right);

/// Trains an adapter of a sentence encoder (its stage is `text`), so that two captions of one clip
/// or class are nearer to each other than to those of other classes: softmax over the batch in both
/// directions. So that English is not forgotten, the cosines between random sequences of one to six
/// words of its vocabulary are kept where they were. Batches are a function of (seed, step).
/// Validation reports, on `val`, how often the right caption of a batch is the nearest, and by how
/// much the cosines of such sequences have moved. Returns the adapter's stage. Throws Error for
/// fewer than two classes, Interrupted after a checkpoint when asked to stop.
nn::ModelStage train_words(const nn::ModelStage& text, const std::vector<CaptionClass>& train,
                           const std::vector<CaptionClass>& val,
                           const WordsTrainingOptions& options, const Monitor& monitor);

}  // namespace remomask::training
