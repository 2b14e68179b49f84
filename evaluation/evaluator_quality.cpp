#include "evaluation/evaluator_quality.h"

#include <torch/utils.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "generator/tokenizer_metrics.h"
#include "text/caption.h"

namespace remomask {

namespace {

constexpr uint64_t kCaptionStream = 0x636170;

std::vector<TrainingClip> clips_with_content(const std::vector<TrainingClip>& clips) {
  std::vector<TrainingClip> kept;
  for (const TrainingClip& clip : clips) {
    if (!clip.content.empty()) kept.push_back(clip);
  }
  return kept;
}

}  // namespace

BatchKeys batch_keys(const TrainingClip& clip, const std::string& caption, DistinctBy distinct) {
  BatchKeys keys = {"caption " + normalise_caption(caption)};
  if (distinct == DistinctBy::labels) {
    keys.push_back(!clip.meaning.empty()   ? "meaning " + clip.meaning
                   : !clip.content.empty() ? "content " + clip.content
                                           : "group " + std::to_string(clip.group));
  }
  return keys;
}

std::vector<EmbeddedPairs> real_pairs(const Evaluator& evaluator,
                                      const std::vector<TrainingClip>& clips, DistinctBy distinct,
                                      int draws, uint64_t seed) {
  const at::Tensor motion = evaluator.embed_motion(clip_features(clips));
  std::vector<EmbeddedPairs> runs;
  for (int draw = 0; draw < draws; ++draw) {
    CounterRandom random(seed, mix_seed(kCaptionStream, static_cast<uint64_t>(draw)));
    EmbeddedPairs run;
    std::vector<std::string> captions;
    for (const TrainingClip& clip : clips) {
      if (clip.captions.empty()) throw Error("clip '" + clip.name + "' has no caption");
      captions.push_back(clip.captions[random.below(clip.captions.size())]);
      run.keys.push_back(batch_keys(clip, captions.back(), distinct));
    }
    run.text = evaluator.embed_text(captions);
    run.motion = run.real = motion;
    runs.push_back(std::move(run));
  }
  return runs;
}

ContentAccuracy nearest_content(const Evaluator& evaluator, const std::vector<TrainingClip>& clips,
                                const std::vector<TrainingClip>& gallery) {
  const auto asked = clips_with_content(clips), known = clips_with_content(gallery);
  const at::Tensor distances = torch::cdist(evaluator.embed_motion(clip_features(asked)),
                                            evaluator.embed_motion(clip_features(known)), 2.0)
                                   .contiguous();
  ContentAccuracy result;
  for (size_t i = 0; i < asked.size(); ++i) {
    const float* row = distances.data_ptr<float>() + i * known.size();
    const TrainingClip* nearest = nullptr;
    float least = std::numeric_limits<float>::infinity();
    for (size_t j = 0; j < known.size(); ++j) {
      if (known[j].group == asked[i].group || row[j] >= least) continue;
      least = row[j];
      nearest = &known[j];
    }
    if (nearest == nullptr) throw Error("the gallery has no clip outside the group of a clip");
    ++result.motions;
    result.right += nearest->content == asked[i].content;
  }
  if (result.motions == 0) return result;
  result.accuracy = static_cast<double>(result.right) / result.motions;
  result.standard_error = std::sqrt(result.accuracy * (1 - result.accuracy) / result.motions);
  return result;
}

}  // namespace remomask
