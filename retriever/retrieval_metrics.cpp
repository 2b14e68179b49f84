#include "retriever/retrieval_metrics.h"

#include <torch/utils.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
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

/// Queries of one direction.
struct RankedQueries {
  std::vector<LabelledQuery> queries;
  std::vector<double> ranks;
  int64_t gallery = 0;
};

/// Clips of one meaning get the number of the first of them; those without labels
/// their own.
at::Tensor meaning_numbers(const std::vector<size_t>& chosen,
                           const std::vector<TrainingClip>& clips) {
  std::map<std::string, int64_t> first_clip;
  for (size_t clip = clips.size(); clip-- > 0;) {
    first_clip[clips[clip].meaning] = static_cast<int64_t>(clip);
  }
  std::vector<int64_t> result;
  for (const size_t clip : chosen) {
    const std::string& meaning = clips[clip].meaning;
    result.push_back(meaning.empty() ? static_cast<int64_t>(clip) : first_clip[meaning]);
  }
  return torch::tensor(result, torch::kLong);
}

RankedQueries ranked_queries(const at::Tensor& similarity, const at::Tensor& correct,
                             const std::vector<size_t>& query_clip,
                             const std::vector<size_t>& gallery_clip,
                             const std::vector<TrainingClip>& clips) {
  RankedQueries result{{}, best_ranks(similarity, correct), similarity.size(1)};
  const at::Tensor first = similarity.argmax(1);
  const at::Tensor same = meaning_numbers(query_clip, clips)
                              .unsqueeze(1)
                              .eq(meaning_numbers(gallery_clip, clips).unsqueeze(0));
  const at::Tensor entries = same.sum(1), right = same.logical_and(correct).sum(1);
  for (size_t i = 0; i < query_clip.size(); ++i) {
    result.queries.push_back({query_clip[i],
                              gallery_clip[static_cast<size_t>(first.data_ptr<int64_t>()[i])],
                              entries.data_ptr<int64_t>()[i], right.data_ptr<int64_t>()[i]});
  }
  return result;
}

/// The queries whose clip carries `subset` as its label "unseen"; "all": every one.
RankedQueries queries_of(const RankedQueries& all, const std::string& subset,
                         const std::vector<TrainingClip>& clips) {
  RankedQueries chosen;
  chosen.gallery = all.gallery;
  for (size_t i = 0; i < all.queries.size(); ++i) {
    if (subset != "all" && clips[all.queries[i].clip].unseen != subset) continue;
    chosen.queries.push_back(all.queries[i]);
    chosen.ranks.push_back(all.ranks[i]);
  }
  return chosen;
}

nlohmann::json figures_json(const RecallFigures& figures, const LabelFigures& labels) {
  nlohmann::json json = {{"median_rank", figures.median_rank},
                         {"queries", figures.queries},
                         {"gallery", figures.gallery}};
  for (size_t i = 0; i < kRecallRanks.size(); ++i) {
    json["R@" + std::to_string(kRecallRanks[i])] = figures.recall[i];
  }
  json["first_hit"] = {{"queries", labels.queries},
                       {"same_content", labels.content},
                       {"same_content_and_style", labels.meaning}};
  for (size_t i = 0; i < kRecallRanks.size(); ++i) {
    json["by_labels_alone"]["R@" + std::to_string(kRecallRanks[i])] = labels.perfect_recall[i];
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

double chance_within(int64_t k, int64_t correct, int64_t entries) {
  double none = 1;
  for (int64_t i = 0; i < k && i < entries; ++i) {
    none *= std::max(0.0, static_cast<double>(entries - correct - i)) /
            static_cast<double>(entries - i);
  }
  return 1 - none;
}

LabelFigures label_figures(const std::vector<LabelledQuery>& queries,
                           const std::vector<TrainingClip>& clips) {
  LabelFigures figures;
  for (const LabelledQuery& query : queries) {
    const TrainingClip &wanted = clips[query.clip], &found = clips[query.first];
    if (wanted.meaning.empty()) continue;
    ++figures.queries;
    if (found.content == wanted.content) ++figures.content;
    if (found.meaning == wanted.meaning) ++figures.meaning;
    for (size_t i = 0; i < kRecallRanks.size(); ++i) {
      figures.perfect_recall[i] +=
          chance_within(kRecallRanks[i], query.correct_of_them, query.same_meaning);
    }
  }
  const double to_percent = 100.0 / static_cast<double>(std::max<int64_t>(1, figures.queries));
  figures.content *= to_percent;
  figures.meaning *= to_percent;
  for (double& recall : figures.perfect_recall) recall *= to_percent;
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
    json[subset.name] = {
        {"text_to_motion", figures_json(subset.text_to_motion, subset.text_to_motion_labels)},
        {"motion_to_text", figures_json(subset.motion_to_text, subset.motion_to_text_labels)}};
  }
}

RetrievalEvaluation evaluate_vectors(const at::Tensor& text, const at::Tensor& motion,
                                     const std::vector<std::string>& captions,
                                     const std::vector<size_t>& caption_clip,
                                     const std::vector<TrainingClip>& clips, bool all_captions) {
  const at::Tensor similarity = torch::matmul(text, motion.t());
  const at::Tensor correct = correct_pairs(captions, caption_clip, clips);
  std::vector<size_t> every_clip(clips.size());
  std::iota(every_clip.begin(), every_clip.end(), 0);
  const RankedQueries texts = ranked_queries(similarity, correct, caption_clip, every_clip, clips);
  // Motions without a correct caption can be no queries.
  const at::Tensor places = correct.any(0).nonzero().flatten();
  const RankedQueries motions =
      ranked_queries(similarity.t().index_select(0, places), correct.t().index_select(0, places),
                     {places.data_ptr<int64_t>(), places.data_ptr<int64_t>() + places.numel()},
                     caption_clip, clips);
  RetrievalEvaluation evaluation{retrieval_protocol(all_captions), {}};
  for (const std::string name : {"all", "take", "pair"}) {
    const RankedQueries by_text = queries_of(texts, name, clips);
    const RankedQueries by_motion = queries_of(motions, name, clips);
    if (by_text.queries.empty()) continue;
    evaluation.subsets.push_back({name, recall_figures(by_text.ranks, by_text.gallery),
                                  recall_figures(by_motion.ranks, by_motion.gallery),
                                  label_figures(by_text.queries, clips),
                                  label_figures(by_motion.queries, clips)});
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
