#include "retriever/embed_database.h"

#include <torch/utils.h>

#include <algorithm>
#include <string>
#include <unordered_map>
#include <vector>

#include "motion/features.h"
#include "nn/tensor_values.h"
#include "remomask/error.h"
#include "remomask/skeleton.h"
#include "retriever/projection.h"
#include "text/caption.h"

namespace remomask::retriever {

namespace {

constexpr int kMinFramesToEmbed = 4;
constexpr size_t kEmbeddingBatch = 32;

/// Many clips share captions: each is encoded once.
class CaptionVectors {
 public:
  explicit CaptionVectors(const Retriever& retriever) : retriever_(retriever) {}

  /// Mean of the captions' vectors, length 1; empty without captions.
  std::vector<float> mean(const std::vector<std::string>& captions) {
    std::vector<at::Tensor> vectors;
    for (const std::string& caption : captions) {
      const std::string normal = text::normalise_caption(caption);
      if (normal.empty()) continue;
      auto known = vectors_.find(normal);
      if (known == vectors_.end()) {
        known = vectors_.emplace(normal, retriever_.encode_text({normal}).query[0]).first;
      }
      vectors.push_back(known->second);
    }
    if (vectors.empty()) return {};
    return nn::float_vector(unit_rows(torch::stack(vectors).mean(0)));
  }

 private:
  const Retriever& retriever_;
  std::unordered_map<std::string, at::Tensor> vectors_;
};

motion::Features stored_features(const db::Database& database, const db::Clip& clip,
                                 motion::FeatureMode mode) {
  try {
    return motion::extract_features_all_frames(database.motion(clip.id),
                                               skeleton_named(clip.skeleton), mode);
  } catch (const Error& error) {
    throw Error("clip '" + clip.name + "': " + error.what());
  }
}

std::vector<db::Clip> clips_to_embed(const db::Database& database,
                                     const std::string& retriever_hash) {
  const db::ReadSnapshot snapshot(database);
  const std::vector<int64_t> stored = database.embedded_clips(retriever_hash);
  if (static_cast<int64_t>(stored.size()) == database.clip_count()) return {};
  std::vector<db::Clip> clips = database.clips();
  std::erase_if(clips, [&](const db::Clip& clip) {
    return clip.frames < kMinFramesToEmbed ||
           std::binary_search(stored.begin(), stored.end(), clip.id);
  });
  return clips;
}

}  // namespace

int64_t embed_database(db::Database& database, const Retriever& retriever, const Monitor& monitor) {
  const std::vector<db::Clip> clips = clips_to_embed(database, retriever.hash());
  CaptionVectors captions(retriever);
  for (size_t first = 0; first < clips.size(); first += kEmbeddingBatch) {
    if (monitor.stop_requested()) {
      throw Interrupted("embedding the database was stopped after " + std::to_string(first) +
                        " of " + std::to_string(clips.size()) +
                        " clips, which are stored; the same command goes on");
    }
    const size_t last = std::min(clips.size(), first + kEmbeddingBatch);
    std::vector<motion::Features> features;
    for (size_t c = first; c < last; ++c) {
      features.push_back(stored_features(database, clips[c], retriever.feature_mode()));
    }
    std::vector<const motion::Features*> batch;
    for (const motion::Features& one : features) batch.push_back(&one);
    const MotionEncoding motion = retriever.encode_motion(batch);
    std::vector<db::ClipEmbedding> embeddings;
    for (size_t c = first; c < last; ++c) {
      const auto row = static_cast<int64_t>(c - first);
      embeddings.push_back({clips[c].id, nn::float_vector(motion.global[row]),
                            nn::float_vector(motion.parts[row].flatten()),
                            captions.mean(clips[c].captions)});
    }
    database.add_embeddings(retriever.hash(), embeddings);
    monitor.report({"embed " + database.path(), static_cast<double>(last),
                    static_cast<double>(clips.size()), ""});
  }
  return static_cast<int64_t>(clips.size());
}

}  // namespace remomask::retriever
