// Top-10 among 1,000,000 vectors of 512 numbers with the type that "auto"
// chooses: one query at a time, recall@10 against the exact answer beside it.
// Needs 8 GB of memory while it builds and two minutes of one core; the
// vectors are a mixture of 2,000 kinds (unit_vectors.h), queries are new ones of
// the same mixture. Floor: reading 2 GB once, what exact search needs at least.

#include <benchmark/benchmark.h>

#include <chrono>
#include <numeric>
#include <set>

#include "bench/machine_peak.h"
#include "bench/unit_vectors.h"
#include "index/vector_index.h"

namespace remomask {
namespace {

constexpr int64_t kCount = 1000000, kQueries = 200, kNearest = 10;
constexpr int kWidth = 512;

struct Million {
  index::VectorIndex index;
  double build_seconds;
};

Million make_million() {
  std::vector<int64_t> ids(kCount);
  std::iota(ids.begin(), ids.end(), 1);
  const auto vectors = clustered_unit_vectors(kCount, kWidth, 1);
  const auto start = std::chrono::steady_clock::now();
  index::VectorIndex index({"bench", 0, "bench"}, ids, vectors, kWidth);
  return {std::move(index),
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
}

const Million& million() {
  static const Million made = make_million();
  return made;
}

const std::vector<float>& queries() {
  static const auto vectors = clustered_unit_vectors(kQueries, kWidth, 2);
  return vectors;
}

/// Against the exact scan that a filter causes.
double measured_recall() {
  const auto found = million().index.search(queries().data(), kQueries, kNearest);
  const auto truth =
      million().index.search(queries().data(), kQueries, kNearest, &million().index.clip_ids());
  int64_t right = 0;
  for (size_t query = 0; query < found.size(); ++query) {
    std::set<int64_t> nearest;
    for (const index::VectorHit& hit : truth[query]) nearest.insert(hit.clip_id);
    for (const index::VectorHit& hit : found[query]) right += nearest.contains(hit.clip_id) ? 1 : 0;
  }
  return static_cast<double>(right) / (kQueries * kNearest);
}

void search_million(benchmark::State& state) {
  static const double recall = measured_recall();
  int64_t query = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        million().index.search(queries().data() + query * kWidth, 1, kNearest));
    query = (query + 1) % kQueries;
  }
  state.counters["recall"] = recall;
  state.counters["stored_recall"] = million().index.type().recall.value_or(1);
  state.counters["build_s"] = million().build_seconds;
  state.SetLabel(million().index.type().factory + " " + million().index.type().search_parameters);
  report_floor(state, 4.0 * kCount * kWidth / memory_read_rate());
}

BENCHMARK(search_million)->Apply(with_medians);

}  // namespace
}  // namespace remomask
