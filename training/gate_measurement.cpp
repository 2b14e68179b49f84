#include "training/gate_measurement.h"

#include <torch/types.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "evaluation/retrieval_metrics.h"
#include "remomask/error.h"
#include "retriever/projection.h"

namespace remomask::training {

namespace {

constexpr double kRightOnesMissed = 0.05, kWrongOnesStopped = 0.5;
constexpr size_t kMotionBlock = 256;

double quantile(std::vector<WeightedSimilarity>& values, double share) {
  std::sort(values.begin(), values.end(),
            [](const auto& a, const auto& b) { return a.similarity < b.similarity; });
  double total = 0;
  for (const auto& value : values) total += value.weight;
  double sum = 0;
  for (const auto& value : values) {
    sum += value.weight;
    if (sum >= share * total * (1 - 1e-12)) return value.similarity;
  }
  return values.back().similarity;
}

/// Vectors of texts and motions, with one count of what is done.
class GateEncoder {
 public:
  GateEncoder(const retriever::Retriever& retriever, const Monitor& monitor, size_t total)
      : retriever_(retriever), monitor_(monitor), total_(static_cast<double>(total)) {}

  at::Tensor texts(const std::vector<std::string>& texts) {
    const auto vectors = evaluation::encode_texts(retriever_, texts, [&](size_t done) {
                           report(done_ + done);
                         }).first;
    done_ += texts.size();
    return vectors;
  }

  at::Tensor motions(const std::vector<const db::TrainingClip*>& clips) {
    std::vector<at::Tensor> vectors;
    for (size_t first = 0; first < clips.size(); first += kMotionBlock) {
      std::vector<const motion::Features*> block;
      for (size_t c = first; c < std::min(clips.size(), first + kMotionBlock); ++c) {
        block.push_back(&clips[c]->features);
      }
      vectors.push_back(retriever_.encode_motion(block).global);
      report(done_ += block.size());
    }
    return torch::cat(vectors);
  }

 private:
  void report(size_t done) const {
    if (monitor_.stop_requested()) throw Interrupted("measuring the evidence gate stopped");
    monitor_.report({"measure evidence gate", static_cast<double>(done), total_, ""});
  }

  const retriever::Retriever& retriever_;
  const Monitor& monitor_;
  double total_;
  size_t done_ = 0;
};

/// Mean of the vectors of every clip's captions, L2-normalised; the captions of one clip
/// follow each other, as many as `counts` says.
at::Tensor mean_vectors(const at::Tensor& captions, const std::vector<int64_t>& counts) {
  std::vector<at::Tensor> result;
  int64_t first = 0;
  for (const int64_t count : counts) {
    result.push_back(captions.slice(0, first, first + count).mean(0));
    first += count;
  }
  return retriever::unit_rows(torch::stack(result));
}

bool is_known(const db::TrainingClip& clip) {
  return !clip.content.empty() && !clip.captions.empty() && clip.features.frames >= 4;
}

/// The gate of one similarity, [captions of val, gallery]; nothing where all hits are right,
/// or none.
std::optional<pipeline::SimilarityGate> gate_of(
    const at::Tensor& similarity, const evaluation::CaptionSet& captions,
    const std::vector<db::TrainingClip>& val, const std::vector<const db::TrainingClip*>& gallery) {
  std::map<std::string, double> count;
  for (const size_t clip : captions.clips) ++count[val[clip].content];
  std::vector<WeightedSimilarity> right, wrong;
  for (size_t i = 0; i < captions.clips.size(); ++i) {
    const db::TrainingClip& asked = val[captions.clips[i]];
    if (asked.content.empty()) continue;
    const float* row = similarity.data_ptr<float>() + i * gallery.size();
    double best_right = -std::numeric_limits<double>::infinity(), best_wrong = best_right;
    for (size_t j = 0; j < gallery.size(); ++j) {
      if (gallery[j]->content != asked.content) {
        best_wrong = std::max(best_wrong, static_cast<double>(row[j]));
      } else if (gallery[j]->group != asked.group) {
        best_right = std::max(best_right, static_cast<double>(row[j]));
      }
    }
    const double weight = 1 / count.at(asked.content);
    if (std::isfinite(best_right)) right.push_back({best_right, weight});
    if (std::isfinite(best_wrong)) wrong.push_back({best_wrong, weight});
  }
  if (right.empty() || wrong.empty()) return std::nullopt;
  return fit_gate(std::move(right), std::move(wrong));
}

}  // namespace

pipeline::SimilarityGate fit_gate(std::vector<WeightedSimilarity> right,
                                  std::vector<WeightedSimilarity> wrong) {
  if (right.empty() || wrong.empty()) {
    throw Error("an evidence gate needs similarities of right hits and of wrong ones");
  }
  const double all = quantile(right, kRightOnesMissed);
  return {std::min(all, quantile(wrong, kWrongOnesStopped)), all};
}

std::optional<pipeline::EvidenceGate> measure_gate(const retriever::Retriever& retriever,
                                                   const std::vector<db::TrainingClip>& train,
                                                   const std::vector<db::TrainingClip>& val,
                                                   const Monitor& monitor) {
  const torch::NoGradGuard no_grad;
  std::vector<const db::TrainingClip*> gallery;
  std::vector<std::string> gallery_captions;
  std::vector<int64_t> caption_counts;
  for (const db::TrainingClip& clip : train) {
    if (!is_known(clip)) continue;
    gallery.push_back(&clip);
    gallery_captions.insert(gallery_captions.end(), clip.captions.begin(), clip.captions.end());
    caption_counts.push_back(static_cast<int64_t>(clip.captions.size()));
  }
  const evaluation::CaptionSet captions = evaluation::caption_set(val, /*all_captions=*/true);
  if (gallery.empty() || captions.texts.empty()) return std::nullopt;
  GateEncoder encoder(retriever, monitor,
                      gallery.size() + gallery_captions.size() + captions.texts.size());
  const at::Tensor texts = encoder.texts(captions.texts);
  const auto gate_by = [&](const at::Tensor& vectors) {
    return gate_of(texts.matmul(vectors.transpose(0, 1)).contiguous(), captions, val, gallery);
  };
  const auto motion = gate_by(encoder.motions(gallery));
  const auto caption = gate_by(mean_vectors(encoder.texts(gallery_captions), caption_counts));
  if (!motion || !caption) return std::nullopt;
  return pipeline::EvidenceGate{*motion, *caption};
}

}  // namespace remomask::training
