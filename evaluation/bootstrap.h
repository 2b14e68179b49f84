#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace remomask::evaluation {

struct BootstrapOptions {
  int resamples = 1000;  ///< 0: no intervals
  double level = 0.95;   ///< share of the resamples inside an interval
  uint64_t seed = 0;
};

struct Interval {
  double low = 0, high = 0;
};

/// Figures of a sample that is given by the numbers of its items.
using SampleStatistic = std::function<std::vector<double>(const std::vector<size_t>&)>;

/// Percentile bootstrap (Efron and Tibshirani 1993, chapter 13): items are drawn
/// with replacement, inside each stratum as many as it has; `strata[i]` is the
/// number of consecutive items of stratum i, and a sample has the same layout.
/// One interval a figure of `statistic`, empty for no resamples or no items. The
/// same seed gives the same intervals. Throws Error for options out of range.
std::vector<Interval> bootstrap_intervals(const std::vector<size_t>& strata,
                                          const SampleStatistic& statistic,
                                          const BootstrapOptions& options = {});

/// Linear interpolation between order statistics; values must be sorted and not empty.
double sorted_quantile(const std::vector<double>& sorted, double share);

}  // namespace remomask::evaluation
