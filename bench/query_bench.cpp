// A text query from the words to the clips, as `remomask search` does it once it
// runs: encode the text, search, fetch ten clips of different groups. Captions
// of the database are the queries, a new one each time; read the lines _p50 and
// _p95. Floor: reading all motion vectors once.
//
// Takes the model that REMOMASK_MODEL names (else models/base.safetensors) and the
// database that REMOMASK_DATABASE names (else models/motions.sqlite), indexed
// for that model.

#include <ATen/core/Tensor.h>
#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <string>

#include "bench/file_named.h"
#include "bench/machine_peak.h"
#include "nn/model_file.h"
#include "retriever/retriever.h"
#include "search/hit_list.h"

namespace remomask {
namespace {

constexpr int kQueries = 200;

struct Searched {
  retriever::Retriever retriever =
      retriever::open_retriever(file_named("REMOMASK_MODEL", "base.safetensors"));
  db::Database database{file_named("REMOMASK_DATABASE", "motions.sqlite"), db::OpenMode::read_only};
  std::shared_ptr<const search::SearchState> state = std::make_shared<search::SearchState>(
      index::VectorIndex::open(index::default_index_path(database.path()), database,
                               retriever.hash()),
      database.clips());
  std::vector<std::string> queries;

  Searched() {
    const std::vector<db::Clip>& clips = state->clips;
    for (int i = 0; i < kQueries; ++i) {
      const db::Clip& clip = clips[clips.size() * static_cast<size_t>(i) / kQueries];
      queries.push_back(clip.captions.empty() ? clip.name : clip.captions.front());
    }
    for (const std::string& query : queries) search(query);  // warm
  }
  size_t search(const std::string& text) const {
    const at::Tensor query = retriever.encode_text({text}).query.contiguous();
    const float* numbers = query.data_ptr<float>();
    search::SearchScene scene;
    scene.state = state;
    return search::collect_hits(scene, {}, {{numbers, numbers + query.numel()}, {}}).hits.size();
  }
};

void text_query(benchmark::State& state) {
  static const Searched searched;
  static size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(searched.search(searched.queries[next++ % kQueries]));
  }
  state.SetLabel(std::to_string(searched.state->index.count()) + " clips");
  report_floor(state, 4.0 * static_cast<double>(searched.state->index.count()) *
                          searched.state->index.width() / memory_read_rate());
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1))];
}

BENCHMARK(text_query)
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime()
    ->Iterations(1)
    ->Repetitions(kQueries)
    ->ReportAggregatesOnly(true)
    ->ComputeStatistics("p50", [](const auto& values) { return quantile(values, 0.50); })
        -> ComputeStatistics("p95", [](const auto& values) { return quantile(values, 0.95); });

}  // namespace
}  // namespace remomask
