#include "retriever/evidence_gate.h"

#include <torch/types.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "base/error.h"
#include "retriever/retrieval_metrics.h"

namespace remomask {

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

std::vector<const TrainingClip*> clips_with_content(const std::vector<TrainingClip>& clips) {
  std::vector<const TrainingClip*> result;
  for (const TrainingClip& clip : clips) {
    if (!clip.content.empty() && clip.features.frames >= 4) result.push_back(&clip);
  }
  return result;
}

}  // namespace

double EvidenceGate::trust(double similarity) const {
  if (similarity >= all) return 1;
  if (similarity <= none) return 0;
  return (similarity - none) / (all - none);
}

EvidenceGate fit_gate(std::vector<WeightedSimilarity> right,
                      std::vector<WeightedSimilarity> wrong) {
  if (right.empty() || wrong.empty()) {
    throw Error("an evidence gate needs similarities of right hits and of wrong ones");
  }
  const double all = quantile(right, kRightOnesMissed);
  return {std::min(all, quantile(wrong, kWrongOnesStopped)), all};
}

std::optional<EvidenceGate> measure_gate(const Retriever& retriever,
                                         const std::vector<TrainingClip>& train,
                                         const std::vector<TrainingClip>& val,
                                         const Monitor& monitor) {
  const torch::NoGradGuard no_grad;
  const auto gallery = clips_with_content(train);
  const CaptionSet captions = caption_set(val, /*all_captions=*/true);
  if (gallery.empty() || captions.texts.empty()) return std::nullopt;
  const double total = static_cast<double>(gallery.size() + captions.texts.size());
  const auto progress = [&](size_t done) {
    if (monitor.stop_requested()) throw Interrupted("measuring the evidence gate stopped");
    monitor.report({"measure evidence gate", static_cast<double>(done), total, ""});
  };
  std::vector<at::Tensor> vectors;
  for (size_t first = 0; first < gallery.size(); first += kMotionBlock) {
    std::vector<const Features*> block;
    for (size_t c = first; c < std::min(gallery.size(), first + kMotionBlock); ++c) {
      block.push_back(&gallery[c]->features);
    }
    vectors.push_back(retriever.encode_motion(block).global);
    progress(first + block.size());
  }
  const at::Tensor texts = encode_texts(retriever, captions.texts, [&](size_t done) {
                             progress(gallery.size() + done);
                           }).first;
  const at::Tensor similarity = texts.matmul(torch::cat(vectors).transpose(0, 1)).contiguous();
  std::map<std::string, double> count;
  for (const size_t clip : captions.clips) ++count[val[clip].content];
  std::vector<WeightedSimilarity> right, wrong;
  for (size_t i = 0; i < captions.clips.size(); ++i) {
    const TrainingClip& asked = val[captions.clips[i]];
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

}  // namespace remomask
