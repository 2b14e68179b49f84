#pragma once

#include <ATen/core/Tensor.h>

#include <array>
#include <cstdint>
#include <vector>

#include "evaluation/bootstrap.h"

namespace remomask::evaluation {

inline constexpr std::array<int, 5> kRecallRanks = {1, 2, 3, 5, 10};

struct RecallFigures {
  std::array<double, 5> recall{};  ///< percent of queries with a correct answer in the first k
  double median_rank = 0;          ///< counted from 1
  int64_t queries = 0;
  int64_t gallery = 0;  ///< entries that a query is ranked against
  /// Empty without a bootstrap, else one of each recall and of the median rank.
  std::vector<Interval> intervals;
};

/// Rank of the best correct entry of each row, counted from 1; entries equal to
/// it that are wrong count half (ties averaged, as in TMR). similarity [Q, N]
/// float, correct [Q, N] bool with at least one true a row. Throws Error for
/// values that are not finite.
std::vector<double> best_ranks(const at::Tensor& similarity, const at::Tensor& correct);

/// Recall and median of ranks; a rank of k + 1/2 is not within k. `batches` are
/// the numbers of consecutive ranks that come from one gallery: the median is
/// taken in each, and averaged by their sizes. The bootstrap draws queries
/// inside each batch.
RecallFigures recall_figures(const std::vector<double>& ranks, const std::vector<size_t>& batches,
                             int64_t gallery, const BootstrapOptions& bootstrap);

}  // namespace remomask::evaluation
