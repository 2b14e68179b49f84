#pragma once

#include <nlohmann/json.hpp>

namespace remomask::pipeline {

/// How far a hit may be trusted, by one similarity: not at all up to `none`, in full from
/// `all` on, in proportion between them.
struct SimilarityGate {
  double none = 0, all = 0;

  /// 0 to 1. A gate of equal limits is a threshold.
  double trust(double similarity) const;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SimilarityGate, none, all)

/// Hits that a search by words found are trusted by their probability: a hit that is more likely
/// wrong than right is not read, and one that is right four times in five in full.
inline constexpr SimilarityGate kProbabilityGate{0.5, 0.8};

/// How far a generator may trust a hit without a probability, by what is known of it: the cosine of
/// sentence and motion, and the cosine of the sentence and the hit's captions (R_t). One of them is
/// enough: motions unlike all that the retriever was trained on are told by their captions alone.
struct EvidenceGate {
  SimilarityGate motion, caption;

  double trust(double motion_similarity, double caption_similarity) const;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(EvidenceGate, motion, caption)

}  // namespace remomask::pipeline
