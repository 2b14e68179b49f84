#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "db/training_set.h"
#include "evaluation/evaluator.h"
#include "evaluation/generation_metrics.h"
#include "evaluation/side_rule.h"

namespace remomask::evaluation {

/// What no two items of a batch of R-precision may share.
enum class DistinctBy { captions, labels };

/// Keys of a clip with one of its captions: the normalised caption; for `labels`
/// also what the clip shows, by TrainingClip::meaning, else content, else group.
BatchKeys batch_keys(const db::TrainingClip& clip, const std::string& caption, DistinctBy distinct);

/// Pairs of real clips, one run a draw: a random caption of each clip, a function
/// of (seed, draw). `real` holds the clips' own vectors. Clips need captions.
std::vector<EmbeddedPairs> real_pairs(const Evaluator& evaluator,
                                      const std::vector<db::TrainingClip>& clips,
                                      DistinctBy distinct, int draws, uint64_t seed);

/// Contents of nearest motions.
struct ContentAccuracy {
  int motions = 0, right = 0;
  double accuracy = 0, standard_error = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ContentAccuracy, motions, right, accuracy, standard_error)

/// Of clips that are judged right (1), wrong (0) or not at all (-1); `members`
/// (empty: all) restricts it.
ContentAccuracy content_accuracy(const std::vector<int>& judged, const std::vector<bool>& members);

/// For every clip whether the nearest clip of the gallery (Euclidean distance,
/// never one of the same group) has its content: 1 or 0; -1 for a clip without
/// content. Throws Error when the gallery has no clip of another group.
std::vector<int> nearest_contents(const Evaluator& evaluator,
                                  const std::vector<db::TrainingClip>& clips,
                                  const std::vector<db::TrainingClip>& gallery);

struct EvaluatorSubset {
  std::string name;            ///< "all", "take", "pair" or "rare"
  GenerationFigures captions;  ///< real pairs, batches with distinct captions
  GenerationFigures labels;    ///< batches with distinct captions, contents and styles
  ContentAccuracy content;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EvaluatorSubset, name, captions, labels, content)

/// What the evaluator says of real clips: the bounds of what it can say of
/// generated ones.
struct EvaluatorQuality {
  std::vector<EvaluatorSubset> subsets;     ///< "all" first; empty ones are left out
  double fid_to_train = 0;                  ///< of all clips to the training clips
  std::map<std::string, SideCounts> sides;  ///< split -> the side rule on real clips
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EvaluatorQuality, subsets, fid_to_train, sides)

/// Figures of `clips` (without captions: left out); contents are looked for among
/// train, val and the clips themselves. `sides` stays empty.
EvaluatorQuality measure_evaluator(const Evaluator& evaluator,
                                   const std::vector<db::TrainingClip>& clips,
                                   const std::vector<db::TrainingClip>& train,
                                   const std::vector<db::TrainingClip>& val,
                                   const GenerationFigureOptions& options);

}  // namespace remomask::evaluation
