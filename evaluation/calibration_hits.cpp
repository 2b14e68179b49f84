#include "evaluation/calibration_hits.h"

#include <torch/utils.h>

#include <algorithm>
#include <numeric>

#include "remomask/error.h"

namespace remomask::evaluation {

JudgedHits judge_hits(const EncodedSplit& split, const std::vector<db::TrainingClip>& clips,
                      int64_t depth) {
  if (depth < 1) throw Error("at least one hit a text is needed");
  const ProtocolPlan plan = protocol_plan(RetrievalProtocol::duplicates, split.captions, clips);
  const at::Tensor similarity = torch::matmul(split.text, split.motion.t()).contiguous();
  const size_t hits = std::min(static_cast<size_t>(depth), clips.size());
  JudgedHits result;
  for (size_t t = 0; t < split.captions.texts.size(); ++t) {
    const float* row = similarity.data_ptr<float>() + t * clips.size();
    const bool* correct = plan.correct.data_ptr<bool>() + t * clips.size();
    std::vector<size_t> order(clips.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::partial_sort(
        order.begin(), order.begin() + static_cast<std::ptrdiff_t>(hits), order.end(),
        [&](size_t a, size_t b) { return row[a] > row[b] || (row[a] == row[b] && a < b); });
    const std::string& meaning = clips[split.captions.clips[t]].meaning;
    for (size_t i = 0; i < hits; ++i) {
      const size_t clip = order[i];
      result.similarities.push_back(row[clip]);
      result.right.push_back(correct[clip] || (!meaning.empty() && clips[clip].meaning == meaning));
    }
  }
  return result;
}

std::vector<double> predicted_shares(const search::Calibration& calibration,
                                     const JudgedHits& hits) {
  std::vector<double> shares;
  for (const double similarity : hits.similarities) {
    shares.push_back(calibration.probability(similarity));
  }
  return shares;
}

}  // namespace remomask::evaluation
