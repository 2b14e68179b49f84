#include "lab/ablation_exam.h"

#include <torch/types.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>

#include "pipeline/physical.h"
#include "remomask/error.h"

namespace remomask::lab {

namespace {

constexpr size_t kJudgeBatch = 64;
constexpr int64_t kLargestRankBatch = 32;

at::Tensor judge_clips(const evaluation::Evaluator& judge,
                       const std::vector<const db::TrainingClip*>& clips) {
  std::vector<at::Tensor> vectors;
  for (size_t first = 0; first < clips.size(); first += kJudgeBatch) {
    std::vector<const motion::Features*> batch;
    for (size_t i = first; i < std::min(clips.size(), first + kJudgeBatch); ++i) {
      batch.push_back(&clips[i]->features);
    }
    vectors.push_back(judge.embed_motion(batch));
  }
  return torch::cat(vectors, 0);
}

/// Motions of the same content and style cannot be told apart by their texts.
std::string rank_key(const db::TrainingClip& clip) {
  return clip.meaning.empty() ? clip.content : clip.meaning;
}

}  // namespace

AblationExam::AblationExam(const evaluation::Evaluator& judge,
                           const std::vector<const db::TrainingClip*>& train,
                           const std::vector<const db::TrainingClip*>& asked,
                           std::vector<evaluation::LabelPrompt> prompts)
    : judge_(judge), prompts_(std::move(prompts)) {
  std::unordered_map<int64_t, const db::TrainingClip*> by_id;
  for (const db::TrainingClip* clip : asked) by_id.emplace(clip->clip_id, clip);
  std::map<std::string, int> trained;
  std::vector<const db::TrainingClip*> gallery;
  for (const db::TrainingClip* clip : train) {
    if (clip->content.empty()) continue;
    ++trained[clip->content];
    gallery.push_back(clip);
    gallery_contents_.push_back(clip->content);
  }
  if (gallery.empty()) throw Error("no training clip has a content label");
  std::vector<const db::TrainingClip*> real;
  std::vector<std::string> texts;
  std::set<std::string> distinct;
  for (const evaluation::LabelPrompt& prompt : prompts_) {
    const auto found = by_id.find(prompt.clip_id);
    if (found == by_id.end()) {
      throw Error("the clip " + prompt.clip + " of a prompt is too short or missing");
    }
    const db::TrainingClip& clip = *found->second;
    real.push_back(&clip);
    groups_.push_back(clip.group);
    texts.push_back(prompt.text);
    keys_.push_back({rank_key(clip)});
    distinct.insert(keys_.back().front());
    subsets_["all"].push_back(true);
    subsets_["take"].push_back(clip.unseen == "take");
    subsets_["pair"].push_back(clip.unseen == "pair");
    subsets_["rare"].push_back(trained[clip.content] < evaluation::kRareClips);
  }
  batch_ = std::min(kLargestRankBatch, static_cast<int64_t>(distinct.size()));
  gallery_ = judge_clips(judge, gallery);
  real_ = judge_clips(judge, real);
  text_ = judge.embed_text(texts);
}

ExamResult AblationExam::figures(const at::Tensor& vectors,
                                 const std::vector<double>& foot_skate) const {
  const at::Tensor nearest = torch::cdist(vectors, gallery_).argmin(1);
  const at::Tensor finite = torch::isfinite(vectors).all(1);
  ExamResult result;
  for (const auto& [name, members] : subsets_) {
    ExamFigures figures;
    for (size_t i = 0; i < prompts_.size(); ++i) {
      if (!members[i]) continue;
      const auto row = static_cast<int64_t>(i);
      const auto place = static_cast<size_t>(nearest[row].item<int64_t>());
      ++figures.prompts;
      figures.foot_skate += foot_skate[i];
      figures.content_right +=
          finite[row].item<bool>() && gallery_contents_[place] == prompts_[i].content;
    }
    if (figures.prompts == 0) continue;
    figures.content_right /= figures.prompts;
    figures.foot_skate /= figures.prompts;
    evaluation::GenerationFigureOptions options;
    options.batch = batch_;
    figures.metrics = measure_pairs({{text_, vectors, real_, keys_}}, options, members);
    result[name] = figures;
  }
  return result;
}

ExamResult AblationExam::grade(const std::vector<Motion>& motions) const {
  if (motions.size() != prompts_.size()) throw Error("the exam needs one motion for each prompt");
  std::vector<at::Tensor> vectors;
  std::vector<double> foot_skate;
  for (const Motion& motion : motions) {
    const PhysicalMetrics physical = pipeline::measure_physical(motion, humanml_skeleton());
    foot_skate.push_back(physical.foot_skate);
    vectors.push_back(physical.finite
                          ? judge_.embed_motion(motion)
                          : torch::full({real_.size(1)}, std::numeric_limits<float>::quiet_NaN()));
  }
  return figures(torch::stack(vectors), foot_skate);
}

ExamResult AblationExam::grade_real() const {
  // Contacts and skating of the real clips are those of their stored positions, which the
  // evaluation of generated motions reports separately.
  return figures(real_, std::vector<double>(prompts_.size(), 0));
}

}  // namespace remomask::lab
