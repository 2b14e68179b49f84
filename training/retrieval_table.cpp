#include "training/retrieval_table.h"

#include <torch/types.h>

#include <algorithm>
#include <limits>

namespace remomask::training {

namespace {

constexpr int64_t kFirstNoiseRank = 20;

int64_t neighbour_count(const RetrievalTable& table, int64_t query) {
  const int64_t ranks = table.neighbours.size(1);
  const int64_t* row = table.neighbours.data_ptr<int64_t>() + query * ranks;
  return std::find(row, row + ranks, int64_t{-1}) - row;
}

DrawnHit hit_at(const RetrievalTable& table, int64_t query, int64_t rank) {
  const int64_t place = query * table.neighbours.size(1) + rank;
  return {table.neighbours.data_ptr<int64_t>()[place], table.similarity.data_ptr<float>()[place]};
}

}  // namespace

RetrievalTable build_retrieval_table(const RetrievalQueries& queries, const at::Tensor& motions,
                                     const MotionKinds& kinds,
                                     const RetrievalTableOptions& options) {
  const torch::NoGradGuard no_grad;
  const int64_t count = queries.text.size(0), database = motions.size(0);
  const int64_t ranks = std::min(options.ranks, database);
  RetrievalTable table{torch::empty({count, ranks}, torch::kLong),
                       torch::empty({count, ranks}, torch::kFloat)};
  const auto int_tensor = [](const std::vector<int>& values) {
    return torch::tensor(std::vector<int64_t>(values.begin(), values.end()), torch::kLong);
  };
  const auto query_groups = int_tensor(queries.kinds.groups);
  const auto motion_groups = int_tensor(kinds.groups);
  const auto query_meanings = int_tensor(queries.kinds.meanings);
  const auto motion_meanings = int_tensor(kinds.meanings);
  const auto equal = [](const at::Tensor& query, const at::Tensor& motion) {
    return query.unsqueeze(1).eq(motion.unsqueeze(0));
  };
  const auto transposed = motions.t();
  for (int64_t first = 0; first < count; first += options.block) {
    const int64_t last = std::min(count, first + options.block);
    auto scores = torch::matmul(queries.text.slice(0, first, last), transposed);
    const auto own = torch::matmul(queries.own_motion.slice(0, first, last), transposed);
    auto excluded = equal(query_groups.slice(0, first, last), motion_groups)
                        .logical_or_(own > options.duplicate_cosine);
    if (!kinds.meanings.empty()) {
      excluded.logical_or_(equal(query_meanings.slice(0, first, last), motion_meanings));
    }
    scores.masked_fill_(excluded, -std::numeric_limits<float>::infinity());
    const auto [values, indices] = torch::topk(scores, ranks, 1);
    const auto missing = values < -2;
    table.neighbours.slice(0, first, last).copy_(indices.masked_fill(missing, -1));
    table.similarity.slice(0, first, last).copy_(values.masked_fill(missing, 0));
  }
  return table;
}

std::vector<DrawnHit> draw_hits(const RetrievalTable& table, int64_t query, int64_t max_hits,
                                double noise, CounterRandom& random) {
  const int64_t available = neighbour_count(table, query);
  const auto wanted = static_cast<int64_t>(random.below(static_cast<size_t>(max_hits + 1)));
  std::vector<DrawnHit> hits;
  for (int64_t i = 0; i < std::min(wanted, available); ++i) {
    int64_t rank = i;
    if (random.uniform() < noise && available > kFirstNoiseRank) {
      rank = kFirstNoiseRank +
             static_cast<int64_t>(random.below(static_cast<size_t>(available - kFirstNoiseRank)));
    }
    hits.push_back(hit_at(table, query, rank));
  }
  return hits;
}

std::vector<DrawnHit> best_hits(const RetrievalTable& table, int64_t query, int64_t k) {
  std::vector<DrawnHit> hits;
  for (int64_t i = 0; i < std::min(k, neighbour_count(table, query)); ++i) {
    hits.push_back(hit_at(table, query, i));
  }
  return hits;
}

}  // namespace remomask::training
