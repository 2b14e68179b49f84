#include "pipeline/candidate_ranking.h"

#include <algorithm>
#include <numeric>

#include "pipeline/motion_embedding.h"
#include "pipeline/physical.h"
#include "remomask/error.h"

namespace remomask::pipeline {

namespace {

constexpr double kAllowedSkate = 0.4, kAllowedJerk = 150, kAllowedPenetration = 0.02;
constexpr double kSkateWeight = 0.1, kJerkWeight = 0.1, kPenetrationWeight = 1, kBendWeight = 0.1;
constexpr double kWorstScore = -1000;

}  // namespace

double jerk_penalty(double jerk) { return kJerkWeight * std::max(0.0, jerk / kAllowedJerk - 1); }

Candidate score_candidate(const retriever::Retriever& retriever, const std::vector<float>& query,
                          const Motion& motion, const Skeleton& skeleton, double bend) {
  const PhysicalMetrics physical = measure_physical(motion, skeleton);
  Candidate result;
  result.bend = bend;
  if (!physical.finite) {
    result.score = kWorstScore;
    return result;
  }
  const std::vector<float> vector = embed_motion(retriever, motion);
  if (vector.size() != query.size()) {
    throw Error("the vectors of prompt and motion are of different width");
  }
  result.similarity = std::inner_product(vector.begin(), vector.end(), query.begin(), 0.0);
  result.skate = physical.foot_skate;
  result.jerk = physical.jerk;
  result.penetration = physical.penetration_max;
  result.score = result.similarity - kSkateWeight * std::max(0.0, result.skate - kAllowedSkate) -
                 jerk_penalty(result.jerk) -
                 kPenetrationWeight * std::max(0.0, result.penetration - kAllowedPenetration) -
                 kBendWeight * bend;
  return result;
}

std::vector<int> rank_candidates(const std::vector<Candidate>& scores) {
  std::vector<int> order(scores.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return scores[static_cast<size_t>(a)].score > scores[static_cast<size_t>(b)].score;
  });
  return order;
}

}  // namespace remomask::pipeline
