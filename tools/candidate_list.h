#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/candidate_ranking.h"
#include "remomask/motion.h"
#include "retriever/retriever.h"
#include "tools/workspace.h"

namespace remomask::tools {

/// Candidates of one motion, of which the best is kept. One candidate is not scored.
template <class Made>
class CandidateList {
 public:
  CandidateList(const retriever::Retriever& retriever, std::string prompt)
      : retriever_(retriever), prompt_(std::move(prompt)) {}

  void add(Made made, uint64_t seed, const Motion& motion, double bend = 0) {
    made_.push_back(std::move(made));
    seeds_.push_back(seed);
    motions_.push_back(motion);
    bends_.push_back(bend);
  }

  /// Scores the candidates and hands out the best one.
  Made take_best() {
    if (made_.size() == 1) return std::move(made_.front());
    const std::vector<float> vector = text_vector(retriever_, prompt_);
    std::vector<pipeline::CandidateScore> scores;
    for (size_t i = 0; i < made_.size(); ++i) {
      scores.push_back(pipeline::score_candidate(retriever_, vector, motions_[i],
                                                 humanml_skeleton(), bends_[i]));
    }
    const std::vector<int> order = pipeline::rank_candidates(scores);
    for (const int i : order) {
      nlohmann::json entry = scores[static_cast<size_t>(i)];
      entry["seed"] = seeds_[static_cast<size_t>(i)];
      ranking_.push_back(std::move(entry));
    }
    return std::move(made_[static_cast<size_t>(order.front())]);
  }

  /// Seeds and scores, the best first; empty for one candidate.
  const nlohmann::json& ranking() const { return ranking_; }

 private:
  const retriever::Retriever& retriever_;
  std::string prompt_;
  std::vector<Made> made_;
  std::vector<uint64_t> seeds_;
  std::vector<Motion> motions_;
  std::vector<double> bends_;
  nlohmann::json ranking_ = nlohmann::json::array();
};

}  // namespace remomask::tools
