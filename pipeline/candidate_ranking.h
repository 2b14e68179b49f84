#pragma once

#include <vector>

#include "remomask/generation.h"
#include "retriever/retriever.h"

namespace remomask::pipeline {

/// score = similarity - 0.1 max(0, skate - 0.4 m/s) / (1 m/s)
///                    - 0.1 max(0, jerk / 150 m/s^3 - 1)
///                    - 1.0 max(0, penetration - 0.02 m) / (1 m) - 0.1 bend.
/// The allowances are what most real clips stay below (docs/results.md), so that only what
/// is worse than them costs anything: of candidates that move like bodies, the one
/// that shows the sentence best wins. A motion with values that are no numbers
/// gets the score -1000. `query` is the retriever's vector of the prompt, [E],
/// L2-normalised.
Candidate score_candidate(const retriever::Retriever& retriever, const std::vector<float>& query,
                          const Motion& motion, const Skeleton& skeleton, double bend = 0);

/// What a jerk (m/s^3) costs in the score: 0.1 max(0, jerk / 150 - 1).
double jerk_penalty(double jerk);

/// Numbers of the candidates, the best first; equal scores in their order.
std::vector<int> rank_candidates(const std::vector<Candidate>& scores);

}  // namespace remomask::pipeline
