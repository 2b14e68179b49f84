#include "search/fusion.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

namespace remomask::search {

std::vector<FusedId> reciprocal_rank_fusion(const std::vector<Ranking>& rankings) {
  struct Place {
    double score = 0;
    size_t first_rank = std::numeric_limits<size_t>::max();
  };
  std::unordered_map<int64_t, Place> places;
  for (size_t r = 0; r < rankings.size(); ++r) {
    const std::vector<int64_t>& ids = rankings[r].ids;
    for (size_t i = 0; i < ids.size(); ++i) {
      Place& place = places[ids[i]];
      place.score += rankings[r].weight / (kFusionConstant + static_cast<double>(i + 1));
      if (r == 0) place.first_rank = i;
    }
  }
  std::vector<FusedId> fused;
  fused.reserve(places.size());
  for (const auto& [id, place] : places) fused.push_back({id, place.score});
  std::sort(fused.begin(), fused.end(), [&](const FusedId& left, const FusedId& right) {
    if (left.score != right.score) return left.score > right.score;
    const size_t left_rank = places.at(left.id).first_rank;
    const size_t right_rank = places.at(right.id).first_rank;
    return left_rank != right_rank ? left_rank < right_rank : left.id < right.id;
  });
  return fused;
}

}  // namespace remomask::search
