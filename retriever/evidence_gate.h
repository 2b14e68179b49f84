#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "db/training_set.h"
#include "retriever/retriever.h"

namespace remomask {

/// How far a hit may be trusted, by one similarity: not at all up to `none`, in full from
/// `all` on, in proportion between them.
struct SimilarityGate {
  double none = 0, all = 0;

  /// 0 to 1. A gate of equal limits is a threshold.
  double trust(double similarity) const;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SimilarityGate, none, all)

/// How far a generator may trust a hit, by what is known of it: the cosine of sentence and
/// motion, and the cosine of the sentence and the hit's captions (R_t). One of them is enough:
/// motions unlike all that the retriever was trained on are told by their captions alone.
struct EvidenceGate {
  SimilarityGate motion, caption;

  double trust(double motion_similarity, double caption_similarity) const;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EvidenceGate, motion, caption)

/// Similarities of hits, each with its weight (above 0).
struct WeightedSimilarity {
  double similarity = 0, weight = 1;
};

/// The gate that 95 % of the `right` similarities pass in full and the lower half of the
/// `wrong` ones not at all: its limits are the median of `wrong` and the 5 % quantile of
/// `right` (the least similarity up to which the hits have that share of the weight), the
/// latter alone where it is less. Throws Error when either list is empty.
SimilarityGate fit_gate(std::vector<WeightedSimilarity> right,
                        std::vector<WeightedSimilarity> wrong);

/// The gate of a retriever, each part by its own similarity. For every caption of a validation
/// clip with a content: right is the best similarity to a training clip of that content and another
/// group, wrong the best one to a training clip of another content, what search would find if the
/// database did not hold what is asked for. Every content weighs the same: else the few that
/// most clips show, and search knows best, would set limits that rare ones miss. Nothing where no
/// clip has a content. Throws Interrupted when asked to stop.
std::optional<EvidenceGate> measure_gate(const Retriever& retriever,
                                         const std::vector<TrainingClip>& train,
                                         const std::vector<TrainingClip>& val,
                                         const Monitor& monitor);

}  // namespace remomask
