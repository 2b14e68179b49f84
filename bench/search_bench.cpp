// Exact top-10 among 100,000 vectors of 512 numbers (205 MB): ours and FAISS's
// IndexFlatIP. Floor: reading all vectors once and multiplying at the GEMM peak,
// whichever takes longer, with as many threads.

#include <benchmark/benchmark.h>
#include <faiss/IndexFlat.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "bench/machine_peak.h"
#include "bench/unit_vectors.h"
#include "index/vector_index.h"

namespace remomask {
namespace {

constexpr int64_t kCount = 100000, kMaxQueries = 64, kNearest = 10;
constexpr int kWidth = 512;

const std::vector<float>& stored_vectors() {
  static const std::vector<float> vectors = random_unit_vectors(kCount, kWidth, 1);
  return vectors;
}

const std::vector<float>& query_vectors() {
  static const std::vector<float> vectors = random_unit_vectors(kMaxQueries, kWidth, 2);
  return vectors;
}

void count_work(benchmark::State& state, int64_t queries) {
  state.SetBytesProcessed(state.iterations() * kCount * kWidth * 4);
  state.SetItemsProcessed(state.iterations() * queries);
  constexpr double kNumbers = double{kCount} * kWidth;
  report_floor(state, std::max(4 * kNumbers / memory_read_rate(),
                               2 * kNumbers * static_cast<double>(queries) / gemm_rate()));
}

void search_remomask(benchmark::State& state) {
  static const index::VectorIndex index = [] {
    std::vector<int64_t> ids(kCount);
    std::iota(ids.begin(), ids.end(), 1);
    return index::VectorIndex({"bench", 0, "bench"}, ids, stored_vectors(), kWidth);
  }();
  const int64_t queries = state.range(0);
  for (auto _ : state) {
    benchmark::DoNotOptimize(index.search(query_vectors().data(), queries, kNearest));
  }
  count_work(state, queries);
}

void search_faiss(benchmark::State& state) {
  static const auto index = [] {
    faiss::IndexFlatIP flat(kWidth);
    flat.add(kCount, stored_vectors().data());
    return flat;
  }();
  const int64_t queries = state.range(0);
  std::vector<float> scores(static_cast<size_t>(queries * kNearest));
  std::vector<int64_t> found(scores.size());
  for (auto _ : state) {
    index.search(queries, query_vectors().data(), kNearest, scores.data(), found.data());
    benchmark::DoNotOptimize(found.data());
  }
  count_work(state, queries);
}

BENCHMARK(search_remomask)->Arg(1)->Arg(kMaxQueries)->Apply(with_medians);
BENCHMARK(search_faiss)->Arg(1)->Arg(kMaxQueries)->Apply(with_medians);

}  // namespace
}  // namespace remomask
