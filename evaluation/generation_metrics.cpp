#include "evaluation/generation_metrics.h"

#include <ATen/ops/linalg_eigh.h>
#include <ATen/ops/linalg_eigvalsh.h>
#include <torch/types.h>
#include <torch/utils.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "remomask/error.h"

namespace remomask::evaluation {

namespace {

constexpr uint64_t kBatchStream = 0x626174, kDiversityStream = 0x646976;
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

at::Tensor as_double(const at::Tensor& rows) { return rows.to(torch::kDouble); }

at::Tensor covariance(const at::Tensor& rows) {
  const at::Tensor centred = rows - rows.mean(0);
  return centred.t().matmul(centred) / static_cast<double>(rows.size(0) - 1);
}

/// Of a symmetric matrix without negative eigenvalues but for rounding.
at::Tensor symmetric_root(const at::Tensor& matrix) {
  const auto [values, vectors] = at::linalg_eigh(matrix, "L");
  return vectors.matmul(torch::diag(values.clamp_min(0).sqrt())).matmul(vectors.t());
}

at::Tensor row_distances(const at::Tensor& a, const at::Tensor& b) {
  return (as_double(a) - as_double(b)).norm(2, -1);
}

at::Tensor drawn_indices(int64_t from, int64_t count, CounterRandom& random) {
  const std::vector<size_t> order = random.permutation(static_cast<size_t>(from));
  return torch::tensor(std::vector<int64_t>(order.begin(), order.begin() + count), torch::kLong);
}

/// Members whose embedding is finite.
std::vector<int64_t> member_rows(const std::vector<bool>& members, const at::Tensor& motion) {
  const at::Tensor finite = motion.isfinite().all(1).contiguous();
  std::vector<int64_t> rows;
  for (int64_t i = 0; i < motion.size(0); ++i) {
    const bool member = members.empty() || members[static_cast<size_t>(i)];
    if (member && finite.data_ptr<bool>()[i]) rows.push_back(i);
  }
  return rows;
}

/// The figures of one draw.
struct DrawnFigures {
  RPrecision top{kNotANumber, kNotANumber, kNotANumber};
  double fid = kNotANumber, mm_dist = kNotANumber, diversity = kNotANumber;
  int64_t ranked = 0;
};

void draw_r_precision(const EmbeddedPairs& run, const GenerationFigureOptions& options,
                      const std::vector<bool>& members, uint64_t draw, DrawnFigures& figures) {
  CounterRandom random(options.seed, mix_seed(kBatchStream, draw));
  RPrecision sum{};
  for (const auto& batch : distinct_batches(run.keys, static_cast<size_t>(options.batch), random)) {
    const at::Tensor rows = torch::tensor(batch, torch::kLong);
    const auto hits = batch_hits(run.text.index_select(0, rows), run.motion.index_select(0, rows));
    for (size_t i = 0; i < batch.size(); ++i) {
      if (!members.empty() && !members[static_cast<size_t>(batch[i])]) continue;
      ++figures.ranked;
      for (size_t k = 0; k < sum.size(); ++k) sum[k] += hits[i][k];
    }
  }
  if (figures.ranked == 0) return;
  for (size_t k = 0; k < sum.size(); ++k) {
    figures.top[k] = sum[k] / static_cast<double>(figures.ranked);
  }
}

DrawnFigures draw_figures(const EmbeddedPairs& run, const GenerationFigureOptions& options,
                          const std::vector<bool>& members, uint64_t draw) {
  DrawnFigures figures;
  draw_r_precision(run, options, members, draw, figures);
  const auto rows = torch::tensor(member_rows(members, run.motion), torch::kLong);
  const at::Tensor motion = run.motion.index_select(0, rows);
  if (motion.size(0) == 0) return figures;
  figures.mm_dist = matching_distance(run.text.index_select(0, rows), motion);
  const at::Tensor real = members.empty() ? run.real : run.real.index_select(0, rows);
  if (motion.size(0) < 2 || real.size(0) < 2) return figures;
  figures.fid = frechet_distance(real, motion);
  const int64_t pairs = options.diversity_pairs > 0 ? options.diversity_pairs
                        : motion.size(0) > 300      ? 300
                                                    : 100;
  CounterRandom random(options.seed, mix_seed(kDiversityStream, draw));
  figures.diversity = diversity(motion, std::min(pairs, motion.size(0)), random);
  return figures;
}

}  // namespace

double frechet_distance(const at::Tensor& mean_a, const at::Tensor& covariance_a,
                        const at::Tensor& mean_b, const at::Tensor& covariance_b) {
  // tr (A B)^(1/2) = sum of the roots of the eigenvalues of A^(1/2) B A^(1/2).
  const at::Tensor root = symmetric_root(covariance_a);
  const at::Tensor product = root.matmul(covariance_b).matmul(root);
  const at::Tensor values = at::linalg_eigvalsh((product + product.t()) / 2, "L");
  const double cross = values.clamp_min(0).sqrt().sum().item<double>();
  const double distance = (mean_a - mean_b).square().sum().item<double>() +
                          covariance_a.trace().item<double>() +
                          covariance_b.trace().item<double>() - 2 * cross;
  return std::max(0.0, distance);
}

double frechet_distance(const at::Tensor& a, const at::Tensor& b) {
  if (a.dim() != 2 || b.dim() != 2 || a.size(1) != b.size(1)) {
    throw Error("the Frechet distance needs two sets of vectors of one width");
  }
  if (a.size(0) < 2 || b.size(0) < 2) {
    throw Error("the Frechet distance needs at least two motions on both sides");
  }
  const at::Tensor x = as_double(a), y = as_double(b);
  return frechet_distance(x.mean(0), covariance(x), y.mean(0), covariance(y));
}

std::vector<std::vector<int64_t>> distinct_batches(const std::vector<BatchKeys>& keys, size_t size,
                                                   CounterRandom& random) {
  struct OpenBatch {
    std::vector<int64_t> items;
    std::set<std::string> keys;
  };
  std::vector<OpenBatch> batches;
  size_t full = 0;  // batches before this one take nothing more
  for (const size_t item : random.permutation(keys.size())) {
    const auto takes = [&](const OpenBatch& batch) {
      return batch.items.size() < size &&
             std::none_of(keys[item].begin(), keys[item].end(),
                          [&](const std::string& key) { return batch.keys.contains(key); });
    };
    while (full < batches.size() && batches[full].items.size() == size) ++full;
    auto place =
        std::find_if(batches.begin() + static_cast<std::ptrdiff_t>(full), batches.end(), takes);
    if (place == batches.end()) place = batches.insert(batches.end(), OpenBatch{});
    place->items.push_back(static_cast<int64_t>(item));
    place->keys.insert(keys[item].begin(), keys[item].end());
  }
  std::vector<std::vector<int64_t>> result;
  for (OpenBatch& batch : batches) {
    if (batch.items.size() == size) result.push_back(std::move(batch.items));
  }
  return result;
}

std::vector<RPrecision> batch_hits(const at::Tensor& text, const at::Tensor& motion) {
  if (text.sizes() != motion.sizes()) {
    throw Error("R-precision needs as many motions as texts, of one width");
  }
  const at::Tensor differences = as_double(text).unsqueeze(1) - as_double(motion).unsqueeze(0);
  const at::Tensor distances = differences.norm(2, 2).contiguous();
  const int64_t count = text.size(0);
  std::vector<RPrecision> hits(static_cast<size_t>(count));
  for (int64_t i = 0; i < count; ++i) {
    const double* row = distances.data_ptr<double>() + i * count;
    int64_t nearer = 0, tied = 0;
    for (int64_t j = 0; j < count; ++j) {
      if (j == i) continue;
      // A motion that is not a number is last.
      if (row[j] < row[i] || (std::isnan(row[i]) && !std::isnan(row[j]))) ++nearer;
      if (row[j] == row[i] || (std::isnan(row[i]) && std::isnan(row[j]))) ++tied;
    }
    for (int k = 1; k <= kMostRank; ++k) {
      hits[static_cast<size_t>(i)][static_cast<size_t>(k - 1)] =
          std::clamp(static_cast<double>(k - nearer) / static_cast<double>(tied + 1), 0.0, 1.0);
    }
  }
  return hits;
}

double matching_distance(const at::Tensor& text, const at::Tensor& motion) {
  return row_distances(text, motion).mean().item<double>();
}

double diversity(const at::Tensor& motion, int64_t pairs, CounterRandom& random) {
  if (pairs < 1 || pairs > motion.size(0)) {
    throw Error("diversity needs between one pair and as many pairs as there are motions");
  }
  const at::Tensor first = drawn_indices(motion.size(0), pairs, random);
  const at::Tensor second = drawn_indices(motion.size(0), pairs, random);
  return row_distances(motion.index_select(0, first), motion.index_select(0, second))
      .mean()
      .item<double>();
}

double multimodality(const at::Tensor& motions, int64_t picks, CounterRandom& random) {
  if (motions.dim() != 3 || motions.size(0) < 1 || picks < 1 || picks > motions.size(1)) {
    throw Error("multimodality needs at least as many generations of each caption as picks");
  }
  const at::Tensor first = drawn_indices(motions.size(1), picks, random);
  const at::Tensor second = drawn_indices(motions.size(1), picks, random);
  return row_distances(motions.index_select(1, first), motions.index_select(1, second))
      .mean()
      .item<double>();
}

Figure figure_of(const std::vector<double>& draws) {
  if (draws.empty()) return {kNotANumber, kNotANumber};
  const auto count = static_cast<double>(draws.size());
  Figure figure;
  for (const double value : draws) figure.mean += value / count;
  double squares = 0;
  for (const double value : draws) squares += (value - figure.mean) * (value - figure.mean);
  figure.interval = 1.96 * std::sqrt(squares / count) / std::sqrt(count);
  return figure;
}

GenerationFigures measure_pairs(const std::vector<EmbeddedPairs>& runs,
                                const GenerationFigureOptions& options,
                                const std::vector<bool>& members) {
  if (runs.empty() || options.draws < 1) throw Error("there is nothing to measure");
  for (const EmbeddedPairs& run : runs) {
    const auto count = static_cast<size_t>(run.motion.size(0));
    if (run.text.sizes() != run.motion.sizes() || run.keys.size() != count ||
        (!members.empty() && (members.size() != count || run.real.size(0) != run.motion.size(0)))) {
      throw Error("texts, motions, keys and members must be equally many");
    }
  }
  std::vector<double> fid, mm_dist, spread;
  std::array<std::vector<double>, kMostRank> top;
  GenerationFigures figures;
  for (int draw = 0; draw < options.draws; ++draw) {
    const EmbeddedPairs& run = runs[static_cast<size_t>(draw) % runs.size()];
    const DrawnFigures drawn = draw_figures(run, options, members, static_cast<uint64_t>(draw));
    fid.push_back(drawn.fid);
    mm_dist.push_back(drawn.mm_dist);
    spread.push_back(drawn.diversity);
    for (size_t k = 0; k < top.size(); ++k) top[k].push_back(drawn.top[k]);
    figures.ranked += drawn.ranked;
  }
  figures.motions = static_cast<int64_t>(member_rows(members, runs.front().motion).size());
  figures.ranked = (figures.ranked + options.draws / 2) / options.draws;
  figures.fid = figure_of(fid);
  figures.mm_dist = figure_of(mm_dist);
  figures.diversity = figure_of(spread);
  for (size_t k = 0; k < top.size(); ++k) figures.r_precision[k] = figure_of(top[k]);
  return figures;
}

}  // namespace remomask::evaluation
