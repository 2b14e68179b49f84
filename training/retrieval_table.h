#pragma once

#include <ATen/core/Tensor.h>

#include <cstdint>
#include <vector>

#include "base/random.h"

namespace remomask::training {

struct RetrievalTableOptions {
  int64_t ranks = 100;             ///< neighbours kept for each query
  double duplicate_cosine = 0.98;  ///< motions more similar than this to the query's own are out
  int64_t block = 512;             ///< queries of one matrix product
};

/// The motions nearest to text queries, made once before training.
struct RetrievalTable {
  at::Tensor neighbours;  ///< int64 [Q, ranks], index of the motion, best first; -1: no more
  at::Tensor similarity;  ///< float [Q, ranks], cosine
};

/// What motions are, for telling which are the same; one entry a motion.
struct MotionKinds {
  std::vector<int> groups;    ///< TrainingClip::group: clip, mirror twin, windows
  std::vector<int> meanings;  ///< equal for equal content and style; empty: they may be equal
};

/// Queries and the motions they belong to, against a database of motions.
struct RetrievalQueries {
  at::Tensor text;        ///< [Q, E] query vectors, L2-normalised
  at::Tensor own_motion;  ///< [Q, E] vector of the motion that the caption describes
  MotionKinds kinds;      ///< [Q] of that motion
};

/// Neighbours of every query among `motions` [N, E] of `kinds` [N]. Never the
/// query's own group, never its meaning where meanings are given, never a
/// near-duplicate of its motion: at test time the answer is not in the database either.
RetrievalTable build_retrieval_table(const RetrievalQueries& queries, const at::Tensor& motions,
                                     const MotionKinds& kinds,
                                     const RetrievalTableOptions& options = {});

struct DrawnHit {
  int64_t motion = 0;
  float similarity = 0;
};

/// Hits of one training sample: the best k, k uniform in 0 .. max_hits, each
/// replaced with probability `noise` by one of the ranks from 20 on, so that the
/// model learns to distrust.
std::vector<DrawnHit> draw_hits(const RetrievalTable& table, int64_t query, int64_t max_hits,
                                double noise, CounterRandom& random);

/// The best k hits, fewer when there are not so many.
std::vector<DrawnHit> best_hits(const RetrievalTable& table, int64_t query, int64_t k);

}  // namespace remomask::training
