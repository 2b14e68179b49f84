#include "evaluation/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/random.h"
#include "remomask/error.h"

namespace remomask::evaluation {

double sorted_quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<size_t>(std::floor(place));
  const size_t above = std::min(below + 1, sorted.size() - 1);
  const double weight = place - static_cast<double>(below);
  return (1 - weight) * sorted[below] + weight * sorted[above];
}

std::vector<Interval> bootstrap_intervals(const std::vector<size_t>& strata,
                                          const SampleStatistic& statistic,
                                          const BootstrapOptions& options) {
  if (options.resamples < 0 || !(options.level > 0 && options.level < 1)) {
    throw Error("a bootstrap needs 0 or more resamples and a level between 0 and 1");
  }
  const size_t items = std::accumulate(strata.begin(), strata.end(), size_t{0});
  if (items == 0 || options.resamples == 0) return {};
  std::vector<std::vector<double>> drawn;  // of each figure
  std::vector<size_t> sample(items);
  for (int resample = 0; resample < options.resamples; ++resample) {
    CounterRandom random(options.seed, static_cast<uint64_t>(resample));
    size_t first = 0;
    for (const size_t count : strata) {
      for (size_t i = 0; i < count; ++i) sample[first + i] = first + random.below(count);
      first += count;
    }
    const std::vector<double> figures = statistic(sample);
    drawn.resize(figures.size());
    for (size_t f = 0; f < figures.size(); ++f) drawn[f].push_back(figures[f]);
  }
  std::vector<Interval> intervals;
  for (std::vector<double>& values : drawn) {
    std::sort(values.begin(), values.end());
    const double tail = (1 - options.level) / 2;
    intervals.push_back({sorted_quantile(values, tail), sorted_quantile(values, 1 - tail)});
  }
  return intervals;
}

}  // namespace remomask::evaluation
