#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "pipeline/physical.h"
#include "retriever/retriever.h"

namespace remomask::pipeline {

/// How well one of several generated motions answers its prompt, and how much a
/// body could do it.
struct CandidateScore {
  double similarity = 0;   ///< cosine of the prompt and the motion, by the retriever
  double skate = 0;        ///< PhysicalMetrics::foot_skate, m/s
  double jerk = 0;         ///< m/s^3
  double penetration = 0;  ///< PhysicalMetrics::penetration_max, m
  double bend = 0;         ///< of an edit: SpliceReport::path_shift in m + path_turn in radians
  double score = 0;        ///< what candidates are ranked by
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CandidateScore, similarity, skate, jerk, penetration, bend,
                                   score)

/// score = similarity - 0.1 max(0, skate - 0.4 m/s) / (1 m/s)
///                    - 0.1 max(0, jerk / 150 m/s^3 - 1)
///                    - 1.0 max(0, penetration - 0.02 m) / (1 m) - 0.1 bend.
/// The allowances are what most real clips stay below (docs/results.md), so that only what
/// is worse than them costs anything: of candidates that move like bodies, the one
/// that shows the sentence best wins. A motion with values that are no numbers
/// gets the score -1000. `query` is the retriever's vector of the prompt, [E],
/// L2-normalised.
CandidateScore score_candidate(const retriever::Retriever& retriever,
                               const std::vector<float>& query, const Motion& motion,
                               const Skeleton& skeleton, double bend = 0);

/// What a jerk (m/s^3) costs in the score: 0.1 max(0, jerk / 150 - 1).
double jerk_penalty(double jerk);

/// Numbers of the candidates, the best first; equal scores in their order.
std::vector<int> rank_candidates(const std::vector<CandidateScore>& scores);

}  // namespace remomask::pipeline
