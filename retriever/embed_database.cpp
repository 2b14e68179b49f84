#include "retriever/embed_database.h"

#include <torch/utils.h>

#include <algorithm>
#include <limits>
#include <set>
#include <unordered_map>

#include "base/error.h"
#include "db/training_set.h"
#include "retriever/projection.h"
#include "text/caption.h"

namespace remomask {

namespace {

constexpr int kLeastFramesToEmbed = 4;
constexpr size_t kEmbeddingBatch = 32;

std::vector<float> float_vector(const at::Tensor& tensor) {
  const at::Tensor flat = tensor.contiguous();
  return {flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel()};
}

/// Many clips share captions: each is encoded once.
class CaptionVectors {
 public:
  explicit CaptionVectors(const Retriever& retriever) : retriever_(retriever) {}

  /// Mean of the captions' vectors, length 1; empty without captions.
  std::vector<float> mean(const std::vector<std::string>& captions) {
    std::vector<at::Tensor> vectors;
    for (const std::string& caption : captions) {
      const std::string normal = normalise_caption(caption);
      if (normal.empty()) continue;
      auto known = vectors_.find(normal);
      if (known == vectors_.end()) {
        known = vectors_.emplace(normal, retriever_.encode_text({normal}).query[0]).first;
      }
      vectors.push_back(known->second);
    }
    if (vectors.empty()) return {};
    return float_vector(unit_rows(torch::stack(vectors).mean(0)));
  }

 private:
  const Retriever& retriever_;
  std::unordered_map<std::string, at::Tensor> vectors_;
};

}  // namespace

int64_t embed_database(Database& database, const Retriever& retriever, const Monitor& monitor) {
  std::set<int64_t> wanted, stored;
  for (const Clip& clip : database.clips()) {
    if (clip.frames >= kLeastFramesToEmbed) wanted.insert(clip.id);
  }
  for (const ClipEmbedding& known : database.embeddings(retriever.hash())) {
    stored.insert(known.clip_id);
  }
  if (wanted == stored) return 0;

  TrainingSetOptions options;
  options.splits = {"train", "val", "test", "none"};
  options.mode = retriever.feature_mode();
  options.add_mirrored = false;
  options.min_frames = kLeastFramesToEmbed;
  options.max_frames = 200;  // of the longest clip: nothing is cut
  const std::vector<TrainingClip> clips = load_training_set(database, options);
  CaptionVectors captions(retriever);
  std::vector<ClipEmbedding> embeddings;
  for (size_t first = 0; first < clips.size(); first += kEmbeddingBatch) {
    if (monitor.stop_requested()) {
      throw Interrupted("embedding the database was stopped; nothing was stored");
    }
    const size_t last = std::min(clips.size(), first + kEmbeddingBatch);
    std::vector<const Features*> features;
    for (size_t c = first; c < last; ++c) features.push_back(&clips[c].features);
    const MotionEncoding motion = retriever.encode_motion(features);
    for (size_t c = first; c < last; ++c) {
      const auto row = static_cast<int64_t>(c - first);
      embeddings.push_back({clips[c].clip_id, float_vector(motion.global[row]),
                            float_vector(motion.parts[row].flatten()),
                            captions.mean(clips[c].captions)});
    }
    monitor.report({"embed " + database.path(), static_cast<double>(last),
                    static_cast<double>(clips.size()), ""});
  }
  database.store_embeddings(retriever.hash(), embeddings);
  return static_cast<int64_t>(embeddings.size());
}

}  // namespace remomask
