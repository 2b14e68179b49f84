#include "evaluation/recall.h"

#include <torch/utils.h>

#include <algorithm>
#include <limits>

#include "remomask/error.h"

namespace remomask::evaluation {

namespace {

double median_of(std::vector<double>& values) {
  const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), half, values.end());
  if (values.size() % 2) return *half;
  return (*half + *std::max_element(values.begin(), half)) / 2;
}

/// The recalls, then the median rank, of the ranks named by `sample`.
std::vector<double> recall_and_median(const std::vector<double>& ranks,
                                      const std::vector<size_t>& batches,
                                      const std::vector<size_t>& sample) {
  std::vector<double> figures(kRecallRanks.size() + 1);
  std::vector<double> batch;
  size_t next = 0;
  for (const size_t count : batches) {
    if (count == 0) continue;
    batch.clear();
    for (size_t i = 0; i < count; ++i) batch.push_back(ranks[sample[next++]]);
    for (size_t k = 0; k < kRecallRanks.size(); ++k) {
      figures[k] +=
          100.0 * static_cast<double>(std::count_if(batch.begin(), batch.end(), [&](double rank) {
            return rank <= kRecallRanks[k];
          }));
    }
    figures.back() += static_cast<double>(count) * median_of(batch);
  }
  for (double& figure : figures) figure /= static_cast<double>(sample.size());
  return figures;
}

}  // namespace

std::vector<double> best_ranks(const at::Tensor& similarity, const at::Tensor& correct) {
  if (!torch::isfinite(similarity).all().item<bool>()) {
    throw Error("the similarities are not finite; the retriever is broken, train it again");
  }
  const at::Tensor wrong = correct.logical_not();
  const at::Tensor best =
      similarity.masked_fill(wrong, -std::numeric_limits<float>::infinity()).amax(1, true);
  const at::Tensor above = similarity.gt(best).logical_and(wrong).sum(1).to(torch::kDouble);
  const at::Tensor ties = similarity.eq(best).logical_and(wrong).sum(1).to(torch::kDouble);
  const at::Tensor ranks = (above + 0.5 * ties + 1).contiguous();
  return {ranks.data_ptr<double>(), ranks.data_ptr<double>() + ranks.numel()};
}

RecallFigures recall_figures(const std::vector<double>& ranks, const std::vector<size_t>& batches,
                             int64_t gallery, const BootstrapOptions& bootstrap) {
  RecallFigures figures;
  figures.queries = static_cast<int64_t>(ranks.size());
  figures.gallery = gallery;
  if (ranks.empty()) return figures;
  std::vector<size_t> every(ranks.size());
  for (size_t i = 0; i < every.size(); ++i) every[i] = i;
  const auto statistic = [&](const std::vector<size_t>& sample) {
    return recall_and_median(ranks, batches, sample);
  };
  const std::vector<double> values = statistic(every);
  std::copy_n(values.begin(), figures.recall.size(), figures.recall.begin());
  figures.median_rank = values.back();
  figures.intervals = bootstrap_intervals(batches, statistic, bootstrap);
  return figures;
}

}  // namespace remomask::evaluation
