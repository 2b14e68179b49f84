#include "evaluation/retrieval_protocols.h"

#include <fmt/format.h>
#include <torch/utils.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "base/random.h"
#include "evaluation/caption_similarity.h"
#include "remomask/error.h"
#include "text/caption.h"

namespace remomask::evaluation {

namespace {

/// Marks of [captions, clips], by row.
class CorrectPairs {
 public:
  CorrectPairs(size_t captions, size_t clips)
      : pairs_(torch::zeros({static_cast<int64_t>(captions), static_cast<int64_t>(clips)},
                            torch::kBool)),
        clips_(clips) {}
  void mark(size_t caption, size_t clip) {
    pairs_.data_ptr<bool>()[caption * clips_ + clip] = true;
  }
  const at::Tensor& tensor() const { return pairs_; }

 private:
  at::Tensor pairs_;
  size_t clips_;
};

at::Tensor own_pairs(const CaptionSet& captions, const std::vector<db::TrainingClip>& clips) {
  CorrectPairs pairs(captions.texts.size(), clips.size());
  for (size_t t = 0; t < captions.texts.size(); ++t) pairs.mark(t, captions.clips[t]);
  return pairs.tensor();
}

at::Tensor similar_pairs(const CaptionSet& captions, const std::vector<db::TrainingClip>& clips,
                         double cosine) {
  CorrectPairs pairs(captions.texts.size(), clips.size());
  const CaptionSimilarity similarity(captions.texts);
  for (size_t t = 0; t < captions.texts.size(); ++t) {
    pairs.mark(t, captions.clips[t]);
    const std::vector<float> row = similarity.row(t);
    for (size_t other = 0; other < row.size(); ++other) {
      if (row[other] > cosine) pairs.mark(t, captions.clips[other]);
    }
  }
  return pairs.tensor();
}

/// Of the same group, or word for word a caption of the clip.
at::Tensor duplicate_pairs(const CaptionSet& captions, const std::vector<db::TrainingClip>& clips) {
  std::map<std::string, std::set<size_t>> clips_with;
  std::map<int, std::vector<size_t>> clips_of_group;
  for (size_t c = 0; c < clips.size(); ++c) {
    for (const std::string& caption : clips[c].captions) {
      clips_with[text::normalise_caption(caption)].insert(c);
    }
    clips_of_group[clips[c].group].push_back(c);
  }
  CorrectPairs pairs(captions.texts.size(), clips.size());
  for (size_t t = 0; t < captions.texts.size(); ++t) {
    for (const size_t clip : clips_with[text::normalise_caption(captions.texts[t])])
      pairs.mark(t, clip);
    for (const size_t clip : clips_of_group[clips[captions.clips[t]].group]) pairs.mark(t, clip);
  }
  return pairs.tensor();
}

std::vector<size_t> clips_with_captions(const CaptionSet& captions) {
  std::vector<size_t> clips = captions.clips;
  clips.erase(std::unique(clips.begin(), clips.end()), clips.end());
  return clips;
}

std::vector<std::vector<size_t>> small_batches(const CaptionSet& captions,
                                               const std::vector<db::TrainingClip>& clips,
                                               const ProtocolSettings& settings) {
  std::vector<size_t> sorted = clips_with_captions(captions);
  std::sort(sorted.begin(), sorted.end(),
            [&](size_t a, size_t b) { return clips[a].name < clips[b].name; });
  CounterRandom random(settings.seed);
  const std::vector<size_t> order = random.permutation(sorted.size());
  const size_t size = std::min(settings.batch, sorted.size());
  std::vector<std::vector<size_t>> batches;
  for (size_t first = 0; size > 0 && first + size <= order.size(); first += size) {
    std::vector<size_t>& batch = batches.emplace_back();
    for (size_t i = first; i < first + size; ++i) batch.push_back(sorted[order[i]]);
    std::sort(batch.begin(), batch.end());
  }
  return batches;
}

}  // namespace

const char* retrieval_protocol_name(RetrievalProtocol protocol) {
  switch (protocol) {
    case RetrievalProtocol::all:
      return "all";
    case RetrievalProtocol::threshold:
      return "threshold";
    case RetrievalProtocol::dissimilar:
      return "dissimilar";
    case RetrievalProtocol::small_batch:
      return "small-batch";
    case RetrievalProtocol::duplicates:
      return "duplicates";
  }
  throw Error("this is no protocol of retrieval");
}

RetrievalProtocol parse_retrieval_protocol(const std::string& name) {
  for (const RetrievalProtocol protocol : kRetrievalProtocols) {
    if (name == retrieval_protocol_name(protocol)) return protocol;
  }
  throw Error("there is no protocol '" + name +
              "'; use all, threshold, dissimilar, small-batch or duplicates");
}

CaptionSet caption_set(const std::vector<db::TrainingClip>& clips, bool all_captions) {
  CaptionSet set;
  for (size_t c = 0; c < clips.size(); ++c) {
    const size_t count = std::min(clips[c].captions.size(), all_captions ? SIZE_MAX : size_t{1});
    for (size_t k = 0; k < count; ++k) {
      set.texts.push_back(clips[c].captions[k]);
      set.clips.push_back(c);
    }
  }
  return set;
}

ProtocolPlan protocol_plan(RetrievalProtocol protocol, const CaptionSet& captions,
                           const std::vector<db::TrainingClip>& clips,
                           const ProtocolSettings& settings) {
  std::vector<size_t> every_clip(clips.size());
  std::iota(every_clip.begin(), every_clip.end(), size_t{0});
  switch (protocol) {
    case RetrievalProtocol::all:
      return {{every_clip}, own_pairs(captions, clips)};
    case RetrievalProtocol::threshold:
      return {{every_clip}, similar_pairs(captions, clips, 2 * settings.threshold - 1)};
    case RetrievalProtocol::dissimilar:
      return {{dissimilar_clips(captions, clips, settings.dissimilar)}, own_pairs(captions, clips)};
    case RetrievalProtocol::small_batch:
      return {small_batches(captions, clips, settings), own_pairs(captions, clips)};
    case RetrievalProtocol::duplicates:
      return {{every_clip}, duplicate_pairs(captions, clips)};
  }
  throw Error("this is no protocol of retrieval");
}

std::string retrieval_definition(RetrievalProtocol protocol, const ProtocolSettings& settings) {
  const std::string own = "the own clip alone is correct";
  switch (protocol) {
    case RetrievalProtocol::all:
      return "full gallery; " + own;
    case RetrievalProtocol::threshold:
      return fmt::format(
          "full gallery; clips with a caption whose similarity in words is above {:g} (cosine "
          "above {:g} of tf-idf vectors of the split's captions) are correct too",
          settings.threshold, 2 * settings.threshold - 1);
    case RetrievalProtocol::dissimilar:
      return fmt::format("gallery of {} clips with captions most unlike in words; {}",
                         settings.dissimilar, own);
    case RetrievalProtocol::small_batch:
      return fmt::format("galleries of {} clips (one permutation, seed {}), mean over them; {}",
                         settings.batch, settings.seed, own);
    case RetrievalProtocol::duplicates:
      return "full gallery; clips of the same group and clips with the identical normalised "
             "caption are correct too";
  }
  throw Error("this is no protocol of retrieval");
}

std::vector<size_t> dissimilar_clips(const CaptionSet& captions,
                                     const std::vector<db::TrainingClip>& clips, size_t count) {
  // One caption a clip, one clip a group.
  std::vector<std::string> texts;
  std::vector<size_t> candidates;
  std::set<int> groups;
  for (size_t t = 0; t < captions.texts.size(); ++t) {
    if (!groups.insert(clips[captions.clips[t]].group).second) continue;
    texts.push_back(captions.texts[t]);
    candidates.push_back(captions.clips[t]);
  }
  const CaptionSimilarity similarity(texts);
  std::vector<float> mean(texts.size());
  for (size_t i = 0; i < texts.size(); ++i) {
    const std::vector<float> row = similarity.row(i);
    mean[i] = std::accumulate(row.begin(), row.end(), 0.f) - row[i];
  }
  std::vector<size_t> chosen;
  // Similarity to the nearest chosen one; the first choice goes by the mean.
  std::vector<float> nearest = mean;
  while (chosen.size() < std::min(count, texts.size())) {
    const auto next =
        static_cast<size_t>(std::min_element(nearest.begin(), nearest.end()) - nearest.begin());
    const std::vector<float> row = similarity.row(next);
    for (size_t i = 0; i < texts.size(); ++i) {
      nearest[i] = chosen.empty() ? row[i] : std::max(nearest[i], row[i]);
    }
    chosen.push_back(candidates[next]);
    candidates[next] = SIZE_MAX;
    for (size_t i = 0; i < texts.size(); ++i) {
      if (candidates[i] == SIZE_MAX) nearest[i] = 2;  // above every cosine: not again
    }
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace remomask::evaluation
