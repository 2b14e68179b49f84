#include "evaluation/evaluator_quality.h"

#include <torch/utils.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "evaluation/label_prompts.h"
#include "evaluation/tokenizer_metrics.h"
#include "remomask/error.h"
#include "text/caption.h"

namespace remomask::evaluation {

namespace {

constexpr uint64_t kCaptionStream = 0x636170;

}  // namespace

BatchKeys batch_keys(const db::TrainingClip& clip, const std::string& caption,
                     DistinctBy distinct) {
  BatchKeys keys = {"caption " + text::normalise_caption(caption)};
  if (distinct == DistinctBy::labels) {
    keys.push_back(!clip.meaning.empty()   ? "meaning " + clip.meaning
                   : !clip.content.empty() ? "content " + clip.content
                                           : "group " + std::to_string(clip.group));
  }
  return keys;
}

std::vector<EmbeddedPairs> real_pairs(const Evaluator& evaluator,
                                      const std::vector<db::TrainingClip>& clips,
                                      DistinctBy distinct, int draws, uint64_t seed) {
  const at::Tensor motion = evaluator.embed_motion(clip_features(clips));
  std::vector<EmbeddedPairs> runs;
  for (int draw = 0; draw < draws; ++draw) {
    CounterRandom random(seed, mix_seed(kCaptionStream, static_cast<uint64_t>(draw)));
    EmbeddedPairs run;
    std::vector<std::string> captions;
    for (const db::TrainingClip& clip : clips) {
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

ContentAccuracy content_accuracy(const std::vector<int>& judged, const std::vector<bool>& members) {
  ContentAccuracy result;
  for (size_t i = 0; i < judged.size(); ++i) {
    if (judged[i] < 0 || (!members.empty() && !members[i])) continue;
    ++result.motions;
    result.right += judged[i];
  }
  if (result.motions == 0) return result;
  result.accuracy = static_cast<double>(result.right) / result.motions;
  result.standard_error = std::sqrt(result.accuracy * (1 - result.accuracy) / result.motions);
  return result;
}

std::vector<int> nearest_contents(const Evaluator& evaluator,
                                  const std::vector<db::TrainingClip>& clips,
                                  const std::vector<db::TrainingClip>& gallery) {
  const at::Tensor distances = torch::cdist(evaluator.embed_motion(clip_features(clips)),
                                            evaluator.embed_motion(clip_features(gallery)), 2.0)
                                   .contiguous();
  std::vector<int> result;
  for (size_t i = 0; i < clips.size(); ++i) {
    if (clips[i].content.empty()) {
      result.push_back(-1);
      continue;
    }
    const float* row = distances.data_ptr<float>() + i * gallery.size();
    const db::TrainingClip* nearest = nullptr;
    float least = std::numeric_limits<float>::infinity();
    for (size_t j = 0; j < gallery.size(); ++j) {
      const bool usable = gallery[j].group != clips[i].group && !gallery[j].content.empty();
      if (!usable || row[j] >= least) continue;
      least = row[j];
      nearest = &gallery[j];
    }
    if (nearest == nullptr) {
      throw Error("the gallery has no clip outside the group of " + clips[i].name);
    }
    result.push_back(nearest->content == clips[i].content ? 1 : 0);
  }
  return result;
}

EvaluatorQuality measure_evaluator(const Evaluator& evaluator,
                                   const std::vector<db::TrainingClip>& all_clips,
                                   const std::vector<db::TrainingClip>& train,
                                   const std::vector<db::TrainingClip>& val,
                                   const GenerationFigureOptions& options) {
  std::vector<db::TrainingClip> clips = all_clips;
  std::erase_if(clips, [](const db::TrainingClip& clip) { return clip.captions.empty(); });
  if (clips.empty()) throw Error("no clip has a caption; import a captions file");
  const auto by_captions =
      real_pairs(evaluator, clips, DistinctBy::captions, options.draws, options.seed);
  const auto by_labels =
      real_pairs(evaluator, clips, DistinctBy::labels, options.draws, options.seed);
  std::vector<db::TrainingClip> gallery = clips;
  gallery.insert(gallery.end(), train.begin(), train.end());
  gallery.insert(gallery.end(), val.begin(), val.end());
  const std::vector<int> judged = nearest_contents(evaluator, clips, gallery);
  std::map<std::string, int> training_clips;
  for (const db::TrainingClip& clip : train) ++training_clips[clip.content];

  EvaluatorQuality quality;
  const auto add = [&](const char* name,
                       const std::function<bool(const db::TrainingClip&)>& member) {
    std::vector<bool> members;
    for (const db::TrainingClip& clip : clips) members.push_back(member(clip));
    if (std::find(members.begin(), members.end(), true) == members.end()) return;
    quality.subsets.push_back({name, measure_pairs(by_captions, options, members),
                               measure_pairs(by_labels, options, members),
                               content_accuracy(judged, members)});
  };
  add("all", [](const db::TrainingClip&) { return true; });
  add("take", [](const db::TrainingClip& clip) { return clip.unseen == "take"; });
  add("pair", [](const db::TrainingClip& clip) { return clip.unseen == "pair"; });
  add("rare", [&](const db::TrainingClip& clip) {
    return !clip.content.empty() && training_clips[clip.content] < kRareClips;
  });
  if (clips.size() > 1 && train.size() > 1) {
    quality.fid_to_train =
        frechet_distance(by_captions.front().motion, evaluator.embed_motion(clip_features(train)));
  }
  return quality;
}

}  // namespace remomask::evaluation
