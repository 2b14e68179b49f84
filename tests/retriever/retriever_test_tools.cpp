#include "tests/retriever/retriever_test_tools.h"

#include <torch/utils.h>

#include "base/random.h"
#include "retriever/retriever_model.h"
#include "tests/encoders/tiny_words.h"

namespace remomask {

namespace {

const std::vector<std::string> kVerbs = {"walks", "runs", "jumps", "turns", "waves", "bows"};
const std::vector<std::string> kManners = {"slowly", "proudly", "sadly", "wildly"};

std::string caption_of_kind(int kind) {
  const auto k = static_cast<size_t>(kind);
  return "a person " + kVerbs[k % kVerbs.size()] + " " + kManners[k / kVerbs.size()];
}

}  // namespace

motion::Features random_features(int frames, uint64_t seed) {
  CounterRandom random(seed);
  motion::Features features(frames, 263);
  for (float& value : features.values) value = static_cast<float>(random.normal());
  return features;
}

std::vector<db::TrainingClip> separable_clips(int kinds, int repeats, uint64_t seed) {
  std::vector<db::TrainingClip> clips;
  for (int kind = 0; kind < kinds; ++kind) {
    const motion::Features pattern = random_features(1, 1000 + static_cast<uint64_t>(kind));
    for (int repeat = 0; repeat < repeats; ++repeat) {
      db::TrainingClip clip;
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

retriever::RetrieverConfig tiny_retriever_config() {
  retriever::RetrieverConfig config = retriever::retriever_preset(ModelSize::tiny);
  config.text_encoder = tiny_words()->tower_hash();
  config.text_encoder_width = tiny_words()->width();
  return config;
}

retriever::Retriever untrained_retriever(uint64_t seed) {
  const retriever::RetrieverConfig config = tiny_retriever_config();
  torch::manual_seed(seed);
  retriever::RetrieverModel model(config, tiny_words()->tower());
  return {{"retriever", config, nn::module_tensors(model)}, tiny_words()};
}

}  // namespace remomask
