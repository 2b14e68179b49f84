#include "tests/retriever/retriever_test_tools.h"

#include <torch/utils.h>

#include "base/random.h"
#include "retriever/retriever_model.h"
#include "text/text_tower.h"

namespace remomask {

namespace {

const std::vector<std::string> kVerbs = {"walks", "runs", "jumps", "turns", "waves", "bows"};
const std::vector<std::string> kManners = {"slowly", "proudly", "sadly", "wildly"};

std::string caption_of_kind(int kind) {
  const auto k = static_cast<size_t>(kind);
  return "a person " + kVerbs[k % kVerbs.size()] + " " + kManners[k / kVerbs.size()];
}

}  // namespace

Features random_features(int frames, uint64_t seed) {
  CounterRandom random(seed);
  Features features(frames, 263);
  for (float& value : features.values) value = static_cast<float>(random.normal());
  return features;
}

std::vector<TrainingClip> separable_clips(int kinds, int repeats, uint64_t seed) {
  std::vector<TrainingClip> clips;
  for (int kind = 0; kind < kinds; ++kind) {
    const Features pattern = random_features(1, 1000 + static_cast<uint64_t>(kind));
    for (int repeat = 0; repeat < repeats; ++repeat) {
      TrainingClip clip;
      clip.group = static_cast<int>(clips.size());
      clip.clip_id = clip.group + 1;
      clip.name = std::to_string(clip.group);
      clip.features = random_features(20 + 3 * (clip.group % 5),
                                      mix_seed(seed, static_cast<uint64_t>(clip.group)));
      for (size_t i = 0; i < clip.features.values.size(); ++i) {
        clip.features.values[i] += pattern.values[i % 263];
      }
      clip.captions = {caption_of_kind(kind)};
      clips.push_back(std::move(clip));
    }
  }
  return clips;
}

RetrieverConfig tiny_retriever_config() {
  RetrieverConfig config = retriever_preset("tiny");
  TextEncoderConfig text = text_encoder_preset("tiny");
  std::vector<std::string> captions;
  for (int kind = 0; kind < 24; ++kind) captions.push_back(caption_of_kind(kind));
  text.vocabulary = train_wordpiece(captions, 300);
  config.text_tower = text;
  return config;
}

Retriever untrained_retriever(uint64_t seed) {
  torch::manual_seed(seed);
  const RetrieverConfig config = tiny_retriever_config();
  RetrieverModel model(config);
  return Retriever({"retriever", config, module_tensors(model)});
}

}  // namespace remomask
