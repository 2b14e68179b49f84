#pragma once

#include <ATen/core/Tensor.h>

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/random.h"

namespace remomask::evaluation {

// Metrics of text-to-motion generation on embeddings [N, E] (Guo et al., CVPR
// 2022; protocol in docs/results.md). All are computed in double precision.

/// Frechet distance of the Gaussians of two sets: |difference of means|^2 +
/// tr(S1 + S2 - 2 (S1 S2)^(1/2)), covariances divided by N - 1. Not below 0.
/// Throws Error for fewer than two rows or other widths.
double frechet_distance(const at::Tensor& a, const at::Tensor& b);

/// The same for given moments: means [E], covariances [E, E].
double frechet_distance(const at::Tensor& mean_a, const at::Tensor& covariance_a,
                        const at::Tensor& mean_b, const at::Tensor& covariance_b);

/// Items of a batch are told from each other by their keys (captions, labels).
using BatchKeys = std::vector<std::string>;

/// Full batches of `size` items in random order; no two items of a batch share a
/// key. Each item goes to the first batch that takes it; what fills no batch is
/// left out. Empty key lists never conflict.
std::vector<std::vector<int64_t>> distinct_batches(const std::vector<BatchKeys>& keys, size_t size,
                                                   CounterRandom& random);

inline constexpr int kMostRank = 3;
/// Share of texts whose own motion is among the k nearest of its batch, k = 1 .. 3.
using RPrecision = std::array<double, kMostRank>;

/// For every text i of a batch (row i of `text` belongs to row i of `motion`) the
/// probability that its motion is among the first k by Euclidean distance; ties
/// are in random order, so that equal motions score as chance.
std::vector<RPrecision> batch_hits(const at::Tensor& text, const at::Tensor& motion);

/// Mean Euclidean distance of row i to row i (MM-Dist, matching score).
double matching_distance(const at::Tensor& text, const at::Tensor& motion);

/// Mean distance of `pairs` pairs: rows drawn without replacement, twice. At most
/// as many pairs as rows.
double diversity(const at::Tensor& motion, int64_t pairs, CounterRandom& random);

/// [C, R, E], R generations of each of C captions: `picks` + `picks` of the
/// generations are drawn, each without replacement and the same for all
/// captions; mean distance of the pairs.
double multimodality(const at::Tensor& motions, int64_t picks, CounterRandom& random);

/// A figure of several draws.
struct Figure {
  double mean = 0;
  double interval = 0;  ///< 1.96 sigma / sqrt(draws), population sigma
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Figure, mean, interval)

Figure figure_of(const std::vector<double>& draws);

/// Texts, the motions that answer them and the real motions of the same items.
struct EmbeddedPairs {
  at::Tensor text, motion;      ///< [N, E]
  at::Tensor real;              ///< [M, E]; of another number of rows too
  std::vector<BatchKeys> keys;  ///< N
};

struct GenerationFigureOptions {
  int draws = 20;
  int64_t batch = 32;           ///< of R-precision
  int64_t diversity_pairs = 0;  ///< 0: 300, or 100 for at most 300 motions (Guo et al.)
  uint64_t seed = 1;
};

struct GenerationFigures {
  int64_t motions = 0;  ///< members with a finite embedding, in the first run
  int64_t ranked = 0;   ///< mean number of texts in full batches
  Figure fid, mm_dist, diversity;
  std::array<Figure, kMostRank> r_precision;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(GenerationFigures, motions, ranked, fid, mm_dist, diversity,
                                   r_precision)

/// Draw d uses runs[d mod runs], all with the same items in the same order.
/// `members` (N, or empty for all) restricts what is averaged: batches are those
/// of the whole set, so that subsets compare; FID and diversity are of the
/// members alone, FID against the rows of `real` with the same numbers. A motion
/// whose embedding is not finite is never ranked first and left out elsewhere. Figures
/// that need more motions than there are (two; for R-precision one that is
/// ranked) are not a number.
GenerationFigures measure_pairs(const std::vector<EmbeddedPairs>& runs,
                                const GenerationFigureOptions& options,
                                const std::vector<bool>& members = {});

}  // namespace remomask::evaluation
