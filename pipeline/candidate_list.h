#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/candidate_ranking.h"
#include "remomask/generation.h"

namespace remomask::pipeline {

/// Seeds of `count` candidates; the first is `seed` itself.
std::vector<uint64_t> candidate_seeds(uint64_t seed, int count);

/// Candidates of one motion, of which the best is kept. A single candidate is not scored.
template <class Made>
class CandidateList {
 public:
  /// `query`: the retriever's vector of the sentence.
  CandidateList(const retriever::Retriever& retriever, std::vector<float> query)
      : retriever_(retriever), query_(std::move(query)) {}

  void add(Made made, uint64_t seed, const Motion& motion, double bend = 0) {
    made_.push_back(std::move(made));
    entries_.push_back({seed, motion, bend});
  }

  /// Scores the candidates and hands out the best one.
  Made take_best() {
    if (made_.size() == 1) {
      best_seed_ = entries_.front().seed;
      return std::move(made_.front());
    }
    std::vector<Candidate> scored;
    for (const Entry& entry : entries_) {
      scored.push_back(
          score_candidate(retriever_, query_, entry.motion, humanml_skeleton(), entry.bend));
      scored.back().seed = entry.seed;
    }
    const std::vector<int> order = rank_candidates(scored);
    for (const int i : order) ranking_.push_back(scored[static_cast<size_t>(i)]);
    best_seed_ = ranking_.front().seed;
    return std::move(made_[static_cast<size_t>(order.front())]);
  }

  /// Best first; empty for a single candidate.
  const std::vector<Candidate>& ranking() const { return ranking_; }
  uint64_t best_seed() const { return best_seed_; }

 private:
  struct Entry {
    uint64_t seed;
    Motion motion;
    double bend;
  };

  const retriever::Retriever& retriever_;
  std::vector<float> query_;
  std::vector<Made> made_;
  std::vector<Entry> entries_;
  std::vector<Candidate> ranking_;
  uint64_t best_seed_ = 0;
};

}  // namespace remomask::pipeline
