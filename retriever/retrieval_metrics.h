#pragma once

#include <ATen/core/Tensor.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/progress.h"
#include "db/training_set.h"
#include "retriever/retriever.h"

namespace remomask {

inline constexpr std::array<int, 5> kRecallRanks = {1, 2, 3, 5, 10};

struct RecallFigures {
  std::array<double, 5> recall{};  ///< percent of queries with a correct answer in the first k
  double median_rank = 0;          ///< counted from 1
  int64_t queries = 0;
  int64_t gallery = 0;
};

/// What the labels of the first hit say, in percent of the queries whose clip
/// has labels; ties go to the lower number.
struct LabelFigures {
  double content = 0;  ///< the asked content (TrainingClip::content)
  double meaning = 0;  ///< the asked content in the asked style (TrainingClip::meaning)
  int64_t queries = 0;
  /// Recall of a search that knows content and style of everything, and puts
  /// the repetitions of the asked ones first in random order: what captions that
  /// say no more than that allow.
  std::array<double, 5> perfect_recall{};
};

/// A query: its own clip, the clip found first, how many entries of the gallery
/// have its meaning and how many of them are correct.
struct LabelledQuery {
  size_t clip = 0, first = 0;
  int64_t same_meaning = 0, correct_of_them = 0;
};
LabelFigures label_figures(const std::vector<LabelledQuery>& queries,
                           const std::vector<TrainingClip>& clips);

/// Probability that at least one of `correct` entries is among the first k of
/// `entries` in random order; 0 < correct <= entries.
double chance_within(int64_t k, int64_t correct, int64_t entries);

/// Rank of the best correct entry of each row, counted from 1; entries equal to
/// it that are wrong count half (ties averaged). similarity [Q, N] float,
/// correct [Q, N] bool with at least one true a row; values must be finite.
std::vector<double> best_ranks(const at::Tensor& similarity, const at::Tensor& correct);

/// Recall and median of ranks. A rank of k + 1/2 is not within k.
RecallFigures recall_figures(const std::vector<double>& ranks, int64_t gallery);

/// The sentence that says how the figures are made; belongs beside them.
std::string retrieval_protocol(bool all_captions);

struct RetrievalSubset {
  std::string name;  ///< "all", "take" or "pair"
  RecallFigures text_to_motion, motion_to_text;
  LabelFigures text_to_motion_labels, motion_to_text_labels;
};

struct RetrievalEvaluation {
  std::string protocol;
  std::vector<RetrievalSubset> subsets;  ///< "all" first; subsets without queries are left out
};

void to_json(nlohmann::json& json, const RetrievalEvaluation& evaluation);

/// Both directions over the whole split `clips` as gallery; "take" and "pair"
/// restrict the queries alone. Text queries: the first caption of each clip, or
/// all; the gallery of motion-to-text has the same captions. Clips without
/// captions only stand in the gallery of motions.
RetrievalEvaluation evaluate_retrieval(const Retriever& retriever,
                                       const std::vector<TrainingClip>& clips, bool all_captions,
                                       const Monitor& monitor = {});

/// Captions and motions already encoded; `caption_clip[i]` is the clip of text i.
RetrievalEvaluation evaluate_vectors(const at::Tensor& text, const at::Tensor& motion,
                                     const std::vector<std::string>& captions,
                                     const std::vector<size_t>& caption_clip,
                                     const std::vector<TrainingClip>& clips, bool all_captions);

}  // namespace remomask
