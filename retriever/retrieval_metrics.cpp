#include "retriever/retrieval_metrics.h"

#include <torch/utils.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "base/error.h"
#include "text/caption.h"

namespace remomask {

namespace {

constexpr size_t kEvaluationBatch = 64;

/// [captions, clips]: the caption belongs to the clip, to one of its group, or
/// is word for word a caption of it.
at::Tensor correct_pairs(const std::vector<std::string>& captions,
                         const std::vector<size_t>& caption_clip,
                         const std::vector<TrainingClip>& clips) {
  std::map<std::string, std::set<size_t>> clips_with;
  for (size_t c = 0; c < clips.size(); ++c) {
    for (const std::string& caption : clips[c].captions) {
      clips_with[normalise_caption(caption)].insert(c);
    }
  }
  std::map<int, std::vector<size_t>> clips_of_group;
  for (size_t c = 0; c < clips.size(); ++c) clips_of_group[clips[c].group].push_back(c);

  const at::Tensor correct = torch::zeros(
      {static_cast<int64_t>(captions.size()), static_cast<int64_t>(clips.size())}, torch::kBool);
  bool* values = correct.data_ptr<bool>();
  for (size_t t = 0; t < captions.size(); ++t) {
    bool* row = values + t * clips.size();
    for (const size_t c : clips_with[normalise_caption(captions[t])]) row[c] = true;
    for (const size_t c : clips_of_group[clips[caption_clip[t]].group]) row[c] = true;
  }
  return correct;
}

RecallFigures figures_of(const std::vector<double>& ranks, const std::vector<bool>& chosen,
                         int64_t gallery) {
  std::vector<double> selected;
  for (size_t i = 0; i < ranks.size(); ++i) {
    if (chosen[i]) selected.push_back(ranks[i]);
  }
  return recall_figures(selected, gallery);
}

nlohmann::json figures_json(const RecallFigures& figures) {
  nlohmann::json json = {{"median_rank", figures.median_rank},
                         {"queries", figures.queries},
                         {"gallery", figures.gallery}};
  for (size_t i = 0; i < kRecallRanks.size(); ++i) {
    json["R@" + std::to_string(kRecallRanks[i])] = figures.recall[i];
  }
  return json;
}

}  // namespace

std::vector<double> best_ranks(const at::Tensor& similarity, const at::Tensor& correct) {
  if (!torch::isfinite(similarity).all().item<bool>()) {
    throw Error("the similarities are not finite; the retriever is broken, train it again");
  }
  const at::Tensor wrong = correct.logical_not();
  const at::Tensor best =
      similarity.masked_fill(wrong, -std::numeric_limits<float>::infinity()).amax(1, true);
  const at::Tensor above = similarity.gt(best).logical_and(wrong).sum(1).to(torch::kDouble);
  const at::Tensor ties = similarity.eq(best).logical_and(wrong).sum(1).to(torch::kDouble);
  const at::Tensor ranks = (above + 0.5 * ties + 1).contiguous();
  return {ranks.data_ptr<double>(), ranks.data_ptr<double>() + ranks.numel()};
}

RecallFigures recall_figures(const std::vector<double>& ranks, int64_t gallery) {
  RecallFigures figures;
  figures.queries = static_cast<int64_t>(ranks.size());
  figures.gallery = gallery;
  if (ranks.empty()) return figures;
  for (size_t i = 0; i < kRecallRanks.size(); ++i) {
    const auto within =
        std::count_if(ranks.begin(), ranks.end(), [&](double r) { return r <= kRecallRanks[i]; });
    figures.recall[i] = 100.0 * static_cast<double>(within) / static_cast<double>(ranks.size());
  }
  std::vector<double> sorted = ranks;
  std::sort(sorted.begin(), sorted.end());
  const size_t half = sorted.size() / 2;
  figures.median_rank = sorted.size() % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
  return figures;
}

std::string retrieval_protocol(bool all_captions) {
  return std::string("full gallery of the split, cosine; ") +
         (all_captions ? "all captions" : "first caption") +
         " of each clip; clips of the same group and clips with the identical normalised caption "
         "count as correct, best rank; ties averaged";
}

void to_json(nlohmann::json& json, const RetrievalEvaluation& evaluation) {
  json = {{"protocol", evaluation.protocol}};
  for (const RetrievalSubset& subset : evaluation.subsets) {
    json[subset.name] = {{"text_to_motion", figures_json(subset.text_to_motion)},
                         {"motion_to_text", figures_json(subset.motion_to_text)}};
  }
}

RetrievalEvaluation evaluate_vectors(const at::Tensor& text, const at::Tensor& motion,
                                     const std::vector<std::string>& captions,
                                     const std::vector<size_t>& caption_clip,
                                     const std::vector<TrainingClip>& clips, bool all_captions) {
  const at::Tensor similarity = torch::matmul(text, motion.t());
  const at::Tensor correct = correct_pairs(captions, caption_clip, clips);
  const std::vector<double> text_ranks = best_ranks(similarity, correct);
  // Motions without a correct caption can be no queries.
  const at::Tensor asked = correct.any(0);
  const at::Tensor places = asked.nonzero().flatten();
  const std::vector<double> motion_ranks =
      best_ranks(similarity.t().index_select(0, places), correct.t().index_select(0, places));
  RetrievalEvaluation evaluation{retrieval_protocol(all_captions), {}};
  for (const std::string name : {"all", "take", "pair"}) {
    const auto belongs = [&](size_t clip) { return name == "all" || clips[clip].unseen == name; };
    std::vector<bool> texts, motions;
    for (const size_t clip : caption_clip) texts.push_back(belongs(clip));
    for (int64_t i = 0; i < places.size(0); ++i) {
      motions.push_back(belongs(static_cast<size_t>(places[i].item<int64_t>())));
    }
    RetrievalSubset subset{name, figures_of(text_ranks, texts, motion.size(0)),
                           figures_of(motion_ranks, motions, text.size(0))};
    if (subset.text_to_motion.queries > 0) evaluation.subsets.push_back(std::move(subset));
  }
  return evaluation;
}

RetrievalEvaluation evaluate_retrieval(const Retriever& retriever,
                                       const std::vector<TrainingClip>& clips, bool all_captions,
                                       const Monitor& monitor) {
  std::vector<std::string> captions;
  std::vector<size_t> caption_clip;
  for (size_t c = 0; c < clips.size(); ++c) {
    const size_t count =
        all_captions ? clips[c].captions.size() : std::min<size_t>(1, clips[c].captions.size());
    for (size_t k = 0; k < count; ++k) {
      captions.push_back(clips[c].captions[k]);
      caption_clip.push_back(c);
    }
  }
  if (captions.empty()) throw Error("the clips to evaluate have no captions");
  const double total = static_cast<double>(captions.size() + clips.size());
  std::vector<at::Tensor> text, motion;
  const auto progress = [&](size_t done) {
    if (monitor.stop_requested()) throw Interrupted("the evaluation of the retriever was stopped");
    monitor.report({"evaluate retriever", static_cast<double>(done), total, ""});
  };
  for (size_t first = 0; first < captions.size(); first += kEvaluationBatch) {
    const size_t last = std::min(captions.size(), first + kEvaluationBatch);
    text.push_back(retriever
                       .encode_text({captions.begin() + static_cast<std::ptrdiff_t>(first),
                                     captions.begin() + static_cast<std::ptrdiff_t>(last)})
                       .query);
    progress(last);
  }
  for (size_t first = 0; first < clips.size(); first += kEvaluationBatch) {
    std::vector<const Features*> chosen;
    for (size_t c = first; c < std::min(clips.size(), first + kEvaluationBatch); ++c) {
      chosen.push_back(&clips[c].features);
    }
    motion.push_back(retriever.encode_motion(chosen).global);
    progress(captions.size() + first + chosen.size());
  }
  return evaluate_vectors(torch::cat(text), torch::cat(motion), captions, caption_clip, clips,
                          all_captions);
}

}  // namespace remomask
