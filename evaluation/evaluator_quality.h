#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "db/training_set.h"
#include "evaluation/evaluator.h"
#include "evaluation/generation_metrics.h"

namespace remomask {

/// What no two items of a batch of R-precision may share.
enum class DistinctBy { captions, labels };

/// Keys of a clip with one of its captions: the normalised caption; for `labels`
/// also what the clip shows, by TrainingClip::meaning, else content, else group.
BatchKeys batch_keys(const TrainingClip& clip, const std::string& caption, DistinctBy distinct);

/// Pairs of real clips, one run a draw: a random caption of each clip, a function
/// of (seed, draw). `real` holds the clips' own vectors. Clips need captions.
std::vector<EmbeddedPairs> real_pairs(const Evaluator& evaluator,
                                      const std::vector<TrainingClip>& clips, DistinctBy distinct,
                                      int draws, uint64_t seed);

/// Contents of nearest motions.
struct ContentAccuracy {
  int motions = 0, right = 0;
  double accuracy = 0, standard_error = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ContentAccuracy, motions, right, accuracy, standard_error)

/// How often the nearest clip of the gallery (Euclidean distance, never one of
/// the same group) has the content of the clip. Clips without content are left
/// out on both sides.
ContentAccuracy nearest_content(const Evaluator& evaluator, const std::vector<TrainingClip>& clips,
                                const std::vector<TrainingClip>& gallery);

}  // namespace remomask
