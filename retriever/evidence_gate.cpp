#include "retriever/evidence_gate.h"

#include <torch/types.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "base/error.h"

namespace remomask {

namespace {

constexpr double kRightOnesMissed = 0.05, kWrongOnesStopped = 0.5;
constexpr size_t kTextBlock = 256;

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
                                         const std::vector<TrainingClip>& val) {
  const torch::NoGradGuard no_grad;
  const auto gallery = clips_with_content(train), asked = clips_with_content(val);
  if (gallery.empty() || asked.empty()) return std::nullopt;
  std::vector<const Features*> features;
  for (const auto* clip : gallery) features.push_back(&clip->features);
  const at::Tensor motions = retriever.encode_motion(features).global;
  std::vector<std::string> captions;
  std::vector<const TrainingClip*> owners;
  std::map<std::string, double> count;
  for (const auto* clip : asked) {
    for (const auto& caption : clip->captions) {
      captions.push_back(caption);
      owners.push_back(clip);
      ++count[clip->content];
    }
  }
  std::vector<WeightedSimilarity> right, wrong;
  for (size_t first = 0; first < captions.size(); first += kTextBlock) {
    const size_t last = std::min(captions.size(), first + kTextBlock);
    const std::vector<std::string> block(captions.begin() + static_cast<std::ptrdiff_t>(first),
                                         captions.begin() + static_cast<std::ptrdiff_t>(last));
    const at::Tensor similarity =
        retriever.encode_text(block).query.matmul(motions.transpose(0, 1)).contiguous();
    for (size_t i = first; i < last; ++i) {
      const float* row =
          similarity.data_ptr<float>() + (i - first) * static_cast<size_t>(similarity.size(1));
      double best_right = -std::numeric_limits<double>::infinity(), best_wrong = best_right;
      for (size_t j = 0; j < gallery.size(); ++j) {
        if (gallery[j]->content != owners[i]->content) {
          best_wrong = std::max(best_wrong, static_cast<double>(row[j]));
        } else if (gallery[j]->group != owners[i]->group) {
          best_right = std::max(best_right, static_cast<double>(row[j]));
        }
      }
      const double weight = 1 / count.at(owners[i]->content);
      if (std::isfinite(best_right)) right.push_back({best_right, weight});
      if (std::isfinite(best_wrong)) wrong.push_back({best_wrong, weight});
    }
  }
  if (right.empty() || wrong.empty()) return std::nullopt;
  return fit_gate(std::move(right), std::move(wrong));
}

}  // namespace remomask
