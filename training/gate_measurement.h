#pragma once

#include <optional>
#include <vector>

#include "db/training_set.h"
#include "pipeline/evidence_gate.h"
#include "remomask/progress.h"
#include "retriever/retriever.h"

namespace remomask::training {

/// Similarities of hits, each with its weight (above 0).
struct WeightedSimilarity {
  double similarity = 0, weight = 1;
};

/// The gate that 95 % of the `right` similarities pass in full and the lower half of the
/// `wrong` ones not at all: its limits are the median of `wrong` and the 5 % quantile of
/// `right` (the least similarity up to which the hits have that share of the weight), the
/// latter alone where it is less. Throws Error when either list is empty.
pipeline::SimilarityGate fit_gate(std::vector<WeightedSimilarity> right,
                                  std::vector<WeightedSimilarity> wrong);

/// The gate of a retriever, each part by its own similarity. For every caption of a validation
/// clip with a content: right is the best similarity to a training clip of that content and another
/// group, wrong the best one to a training clip of another content, what search would find if the
/// database did not hold what is asked for. Every content weighs the same: else the few that
/// most clips show, and search knows best, would set limits that rare ones miss. Nothing where no
/// clip has a content. Throws Interrupted when asked to stop.
std::optional<pipeline::EvidenceGate> measure_gate(const retriever::Retriever& retriever,
                                                   const std::vector<db::TrainingClip>& train,
                                                   const std::vector<db::TrainingClip>& val,
                                                   const Monitor& monitor);

}  // namespace remomask::training
