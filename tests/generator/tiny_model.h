#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/encoders/tiny_words.h"
#include "tests/tokenizer/tokenizer_test_tools.h"
#include "training/generator_data.h"
#include "training/presets.h"
#include "training/retriever_training.h"
#include "training/tokenizer_training.h"
#include "training/transformer_training.h"

namespace remomask {

inline std::vector<db::TrainingClip> captioned_clips() {
  std::vector<db::TrainingClip> clips = swinging_clips({40, 48, 60, 44, 52, 72, 41, 64});
  const std::vector<std::string> texts = {"a person walks", "someone runs in a circle",
                                          "a man waves", "a person jumps and turns"};
  for (size_t i = 0; i < clips.size(); ++i) {
    clips[i].split = "train";
    clips[i].group = static_cast<int>(i / 2);
    clips[i].captions = {texts[i % 4], texts[(i + 1) % 4] + " slowly"};
  }
  return clips;
}

/// The four networks of a model, and the data that the transformers learnt from.
struct TinyModel {
  std::map<std::string, nn::ModelStage> stages;
  training::GeneratorData data;

  /// Each network after two steps.
  TinyModel(const training::ModelConfig& config, const std::vector<db::TrainingClip>& clips) {
    const auto trainer = [](const std::string& name) {
      training::TrainerOptions options;
      options.steps = 2;
      options.stage_name = name;
      return options;
    };
    training::RetrieverTrainingOptions retriever_options(ModelSize::tiny);
    retriever_options.trainer = trainer("retriever");
    retriever_options.batch = 4;
    stages["retriever"] =
        training::train_retriever(clips, {}, tiny_words(), config.retriever, retriever_options, {});
    training::TokenizerTrainingOptions tokenizer_options;
    tokenizer_options.trainer = trainer("tokenizer");
    tokenizer_options.window = 32;
    tokenizer_options.batch_frames = 256;
    stages["tokenizer"] =
        training::train_tokenizer(clips, clips, config.tokenizer, tokenizer_options, {});
    data = training::prepare_generator_data(
        clips, {clips[0]}, tokenizer::Tokenizer(stages["tokenizer"]),
        retriever::Retriever(stages["retriever"], tiny_words()), {});
    training::TransformerTrainingOptions options;
    options.batch = 4;
    options.trainer = trainer("masked");
    stages["masked"] = training::train_masked(config.masked, data, options, {});
    options.trainer = trainer("residual");
    stages["residual"] = training::train_residual(config.residual, data, options, {});
  }
};

/// A model of preset tiny, made once.
inline TinyModel& tiny_model() {
  static TinyModel model(training::model_preset(parse_preset("tiny")), captioned_clips());
  return model;
}

}  // namespace remomask
