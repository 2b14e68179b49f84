#include "evaluation/retrieval_metrics.h"

#include <torch/utils.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "base/hash.h"
#include "remomask/error.h"

namespace remomask::evaluation {

namespace {

constexpr size_t kEvaluationBatch = 64;

at::Tensor places(const std::vector<size_t>& numbers) {
  return torch::tensor(std::vector<int64_t>(numbers.begin(), numbers.end()), torch::kLong);
}

/// Queries of one direction, gallery after gallery.
struct RankedQueries {
  std::vector<LabelledQuery> queries;
  std::vector<double> ranks;
  std::vector<size_t> batches;  ///< queries of each gallery
  int64_t gallery = 0;
};

/// Clips of one meaning get the number of the first of them; those without labels
/// their own.
std::vector<int64_t> meaning_numbers(const std::vector<db::TrainingClip>& clips) {
  std::map<std::string, int64_t> first_clip;
  std::vector<int64_t> result;
  for (size_t clip = 0; clip < clips.size(); ++clip) {
    const auto own = static_cast<int64_t>(clip);
    const std::string& meaning = clips[clip].meaning;
    result.push_back(meaning.empty() ? own : first_clip.emplace(meaning, own).first->second);
  }
  return result;
}

/// Adds the queries of one gallery; rows without a correct entry are no queries.
void rank_gallery(const at::Tensor& similarity, const at::Tensor& correct,
                  const std::vector<size_t>& query_clip, const std::vector<size_t>& gallery_clip,
                  const at::Tensor& meanings, RankedQueries& result) {
  const at::Tensor rows = correct.any(1).nonzero().flatten();
  const at::Tensor scores = similarity.index_select(0, rows), right = correct.index_select(0, rows);
  const std::vector<double> ranks = best_ranks(scores, right);
  result.ranks.insert(result.ranks.end(), ranks.begin(), ranks.end());
  result.batches.push_back(ranks.size());
  result.gallery = similarity.size(1);
  if (ranks.empty()) return;
  const at::Tensor first = scores.argmax(1);
  const at::Tensor same = meanings.index_select(0, places(query_clip))
                              .index_select(0, rows)
                              .unsqueeze(1)
                              .eq(meanings.index_select(0, places(gallery_clip)).unsqueeze(0));
  const at::Tensor entries = same.sum(1), right_entries = same.logical_and(right).sum(1);
  for (size_t i = 0; i < ranks.size(); ++i) {
    result.queries.push_back({query_clip[static_cast<size_t>(rows.data_ptr<int64_t>()[i])],
                              gallery_clip[static_cast<size_t>(first.data_ptr<int64_t>()[i])],
                              entries.data_ptr<int64_t>()[i],
                              right_entries.data_ptr<int64_t>()[i]});
  }
}

/// The queries whose clip carries `subset` as its label "unseen"; "all": every one.
DirectionFigures figures_of(const RankedQueries& all, const std::string& subset,
                            const std::vector<db::TrainingClip>& clips,
                            const BootstrapOptions& bootstrap) {
  std::vector<LabelledQuery> queries;
  std::vector<double> ranks;
  std::vector<size_t> batches;
  size_t next = 0;
  for (const size_t count : all.batches) {
    const size_t before = ranks.size();
    for (const size_t last = next + count; next < last; ++next) {
      if (subset != "all" && clips[all.queries[next].clip].unseen != subset) continue;
      queries.push_back(all.queries[next]);
      ranks.push_back(all.ranks[next]);
    }
    batches.push_back(ranks.size() - before);
  }
  return {recall_figures(ranks, batches, all.gallery, bootstrap), label_figures(queries, clips)};
}

std::string names_hash(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  std::string lines;
  for (const std::string& name : names) lines += name + '\n';
  return content_hash(lines);
}

ProtocolEvaluation evaluate_protocol(RetrievalProtocol protocol, const EncodedSplit& split,
                                     const std::vector<db::TrainingClip>& clips,
                                     const RetrievalOptions& options) {
  const ProtocolPlan plan = protocol_plan(protocol, split.captions, clips, options.settings);
  const at::Tensor meanings = torch::tensor(meaning_numbers(clips), torch::kLong);
  RankedQueries texts, motions;
  std::vector<std::string> searched;
  for (const std::vector<size_t>& gallery : plan.galleries) {
    std::vector<size_t> captions, caption_clip;
    for (size_t t = 0; t < split.captions.texts.size(); ++t) {
      const size_t clip = split.captions.clips[t];
      if (!std::binary_search(gallery.begin(), gallery.end(), clip)) continue;
      captions.push_back(t);
      caption_clip.push_back(clip);
    }
    for (const size_t clip : gallery) searched.push_back(clips[clip].name);
    const at::Tensor rows = places(captions), columns = places(gallery);
    const at::Tensor similarity =
        torch::matmul(split.text.index_select(0, rows), split.motion.index_select(0, columns).t());
    const at::Tensor correct = plan.correct.index_select(0, rows).index_select(1, columns);
    rank_gallery(similarity, correct, caption_clip, gallery, meanings, texts);
    rank_gallery(similarity.t().contiguous(), correct.t().contiguous(), gallery, caption_clip,
                 meanings, motions);
  }
  ProtocolEvaluation result{
      protocol, retrieval_definition(protocol, options.settings), names_hash(searched), {}};
  for (const std::string name : {"all", "take", "pair"}) {
    const DirectionFigures by_text = figures_of(texts, name, clips, options.bootstrap);
    if (by_text.recall.queries == 0) continue;
    result.subsets.push_back({name, by_text, figures_of(motions, name, clips, options.bootstrap)});
  }
  return result;
}

nlohmann::json direction_json(const DirectionFigures& figures) {
  const RecallFigures& recall = figures.recall;
  nlohmann::json json = {{"queries", recall.queries}, {"gallery", recall.gallery}};
  const auto add = [&](const std::string& name, double value, size_t place) {
    json[name] = value;
    if (recall.intervals.empty()) return;
    json["intervals"][name] = {recall.intervals[place].low, recall.intervals[place].high};
  };
  for (size_t i = 0; i < kRecallRanks.size(); ++i) {
    const std::string name = "R@" + std::to_string(kRecallRanks[i]);
    add(name, recall.recall[i], i);
    json["by_labels_alone"][name] = figures.labels.perfect_recall[i];
  }
  add("median_rank", recall.median_rank, kRecallRanks.size());
  json["first_hit"] = {{"queries", figures.labels.queries},
                       {"same_content", figures.labels.content},
                       {"same_content_and_style", figures.labels.meaning}};
  return json;
}

}  // namespace

void to_json(nlohmann::json& json, const RetrievalEvaluation& evaluation) {
  json = {{"clips", evaluation.clips},
          {"split_hash", evaluation.split_hash},
          {"captions", evaluation.captions},
          {"bootstrap",
           {{"resamples", evaluation.bootstrap.resamples},
            {"level", evaluation.bootstrap.level},
            {"seed", evaluation.bootstrap.seed}}}};
  for (const ProtocolEvaluation& protocol : evaluation.protocols) {
    nlohmann::json& figures = json["protocols"][retrieval_protocol_name(protocol.protocol)];
    figures = {{"definition", protocol.definition}, {"gallery_hash", protocol.gallery_hash}};
    for (const RetrievalSubset& subset : protocol.subsets) {
      figures[subset.name] = {{"text_to_motion", direction_json(subset.text_to_motion)},
                              {"motion_to_text", direction_json(subset.motion_to_text)}};
    }
  }
}

std::string clip_set_hash(const std::vector<db::TrainingClip>& clips) {
  std::vector<std::string> names;
  for (const db::TrainingClip& clip : clips) names.push_back(clip.name);
  return names_hash(std::move(names));
}

std::pair<at::Tensor, at::Tensor> encode_texts(const retriever::Retriever& retriever,
                                               const std::vector<std::string>& texts,
                                               const std::function<void(size_t)>& progress) {
  std::vector<at::Tensor> queries, parts;
  for (size_t first = 0; first < texts.size(); first += kEvaluationBatch) {
    const size_t last = std::min(texts.size(), first + kEvaluationBatch);
    const retriever::TextEncoding encoding =
        retriever.encode_text({texts.begin() + static_cast<std::ptrdiff_t>(first),
                               texts.begin() + static_cast<std::ptrdiff_t>(last)});
    queries.push_back(encoding.query);
    parts.push_back(encoding.parts);
    progress(last);
  }
  return {torch::cat(queries), torch::cat(parts)};
}

EncodedSplit encode_split(const retriever::Retriever& retriever,
                          const std::vector<db::TrainingClip>& clips, bool all_captions,
                          const Monitor& monitor) {
  EncodedSplit split;
  split.captions = caption_set(clips, all_captions);
  const std::vector<std::string>& captions = split.captions.texts;
  if (captions.empty()) throw Error("the clips to evaluate have no captions");
  const double total = static_cast<double>(captions.size() + clips.size());
  const auto progress = [&](size_t done) {
    if (monitor.stop_requested()) throw Interrupted("the evaluation of the retriever was stopped");
    monitor.report({"evaluate retriever", static_cast<double>(done), total, ""});
  };
  std::vector<at::Tensor> motion, motion_parts;
  std::tie(split.text, split.text_parts) = encode_texts(retriever, captions, progress);
  for (size_t first = 0; first < clips.size(); first += kEvaluationBatch) {
    std::vector<const motion::Features*> chosen;
    for (size_t c = first; c < std::min(clips.size(), first + kEvaluationBatch); ++c) {
      chosen.push_back(&clips[c].features);
    }
    const retriever::MotionEncoding encoding = retriever.encode_motion(chosen);
    motion.push_back(encoding.global);
    motion_parts.push_back(encoding.parts);
    progress(captions.size() + first + chosen.size());
  }
  split.motion = torch::cat(motion);
  split.motion_parts = torch::cat(motion_parts);
  return split;
}

RetrievalEvaluation evaluate_encoded(const EncodedSplit& split,
                                     const std::vector<db::TrainingClip>& clips,
                                     const RetrievalOptions& options) {
  RetrievalEvaluation evaluation;
  evaluation.clips = clips.size();
  evaluation.split_hash = clip_set_hash(clips);
  evaluation.captions = std::string(options.all_captions ? "all captions" : "first caption") +
                        " of each clip; cosine; best rank of the correct entries, ties averaged";
  evaluation.bootstrap = options.bootstrap;
  for (const RetrievalProtocol protocol : options.protocols) {
    evaluation.protocols.push_back(evaluate_protocol(protocol, split, clips, options));
  }
  return evaluation;
}

RetrievalEvaluation evaluate_retrieval(const retriever::Retriever& retriever,
                                       const std::vector<db::TrainingClip>& clips,
                                       const RetrievalOptions& options, const Monitor& monitor) {
  return evaluate_encoded(encode_split(retriever, clips, options.all_captions, monitor), clips,
                          options);
}

}  // namespace remomask::evaluation
