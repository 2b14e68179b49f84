#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "db/training_set.h"
#include "retriever/retriever.h"

namespace remomask {

/// Where the config of a model's masked stage holds its gate.
inline constexpr const char* kEvidenceGateKey = "evidence_gate";

/// How far a hit may be trusted, by its similarity (cosine of sentence and motion): a
/// generator takes none of it below `none`, the full share from `all` on, and a
/// share in proportion between them.
struct EvidenceGate {
  double none = 0, all = 0;

  /// 0 to 1. A gate of equal limits is a threshold.
  double trust(double similarity) const;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EvidenceGate, none, all)

/// The gate that 95 % of the `right` similarities pass at least in part and 95 % of the
/// `wrong` ones not in full: its limits are the 5 % quantile of `right` and the 95 % quantile
/// of `wrong`; where these are the other way round, nothing needs a part, and the
/// middle between them is a threshold. Throws Error when either list is empty.
EvidenceGate fit_gate(std::vector<double> right, std::vector<double> wrong);

/// The gate of a retriever. For every caption of a validation clip with a content: right is the
/// best similarity to a training clip of that content and another group, wrong the best
/// one to a training clip of another content, what search would find if the
/// database did not hold what is asked for. Nothing where no clip has a content.
std::optional<EvidenceGate> measure_gate(const Retriever& retriever,
                                         const std::vector<TrainingClip>& train,
                                         const std::vector<TrainingClip>& val);

}  // namespace remomask
