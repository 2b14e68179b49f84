#pragma once

#include <cstdint>
#include <vector>

namespace remomask::search {

struct Ranking {
  std::vector<int64_t> ids;  ///< best first, each id once
  double weight = 1;         ///< not negative
};

struct FusedId {
  int64_t id = 0;
  double score = 0;
};

/// Damps the difference between the first ranks; the published value.
inline constexpr double kFusionConstant = 60;

/// Reciprocal rank fusion (Cormack, Clarke, Buettcher, SIGIR 2009): the score of an id is the sum
/// of weight / (60 + rank) over the rankings that contain it, with ranks from 1. Best first. Equal
/// scores come in the order of the first ranking; ids that it lacks come last, ascending. Every id
/// of any ranking appears once.
std::vector<FusedId> reciprocal_rank_fusion(const std::vector<Ranking>& rankings);

}  // namespace remomask::search
