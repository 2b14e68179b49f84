// 1,000 new clips beside an index of 67,000: what it costs to take them over,
// beside building the whole index anew from the stored vectors (width 512).
// Embedding is not part of either.

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <optional>

#include "bench/machine_peak.h"
#include "bench/unit_vectors.h"
#include "index/index_changes.h"
#include "index/update_index.h"

namespace remomask {
namespace {

constexpr int kBefore = 67000, kNew = 1000, kWidth = 512;
constexpr const char* kRetriever = "0123456789abcdef0123456789abcdef";

void add_clips(Database& database, int first, int count) {
  const auto vectors = random_unit_vectors(count, kWidth, static_cast<uint64_t>(first));
  std::vector<ClipEmbedding> embeddings;
  database.begin();
  for (int i = 0; i < count; ++i) {
    Clip clip;
    clip.name = "clip" + std::to_string(first + i);
    clip.source = "bench";
    clip.source_file = clip.name;
    clip.split = "train";
    clip.captions = {"a person does number " + std::to_string(first + i)};
    Motion motion(2, 22);
    motion.positions[0] = static_cast<float>(first + i);
    const auto vector = vectors.begin() + static_cast<int64_t>(i) * kWidth;
    const std::vector<float> row(vector, vector + kWidth);
    // Parts and text as wide as a retriever of this width makes them.
    embeddings.push_back(
        {database.add_clip(clip, motion), row, std::vector<float>(6 * kWidth / 4, 0.5f), row});
  }
  database.add_embeddings(kRetriever, embeddings);
  database.commit();
}

/// Two states of one database, and the index of the earlier one.
struct TwoStates {
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("index_bench_" + std::to_string(getpid()));
  std::string index_path = (folder / "motions.index").string();
  std::optional<Database> before, after;

  TwoStates() {
    std::filesystem::create_directories(folder);
    const std::string early = (folder / "before.sqlite").string();
    const std::string late = (folder / "after.sqlite").string();
    {
      Database database(early, OpenMode::create);
      add_clips(database, 0, kBefore);
    }
    std::filesystem::copy_file(early, late);
    before.emplace(early, OpenMode::read_only);
    after.emplace(late, OpenMode::read_write);
    add_clips(*after, kBefore, kNew);
    update_index(index_path, *before, kRetriever);
  }
  ~TwoStates() {
    before.reset();
    after.reset();
    std::filesystem::remove_all(folder);
  }
};

TwoStates& states() {
  static TwoStates two;
  return two;
}

void index_rebuild(benchmark::State& state) {
  const std::string path = (states().folder / "rebuilt.index").string();
  UpdateOptions options;
  options.rebuild = true;
  for (auto _ : state) update_index(path, *states().after, kRetriever, options);
}

/// What `remomask index` does after embedding: from the files to the files.
void index_update_files(benchmark::State& state) {
  for (auto _ : state) {
    state.PauseTiming();
    std::filesystem::remove(delta_path(states().index_path));
    state.ResumeTiming();
    if (update_index(states().index_path, *states().after, kRetriever).difference.added != kNew) {
      state.SkipWithError("the new clips were not added");
    }
  }
}

/// An open index takes the new state over.
void index_follow(benchmark::State& state) {
  std::filesystem::remove(delta_path(states().index_path));
  for (auto _ : state) {
    state.PauseTiming();
    auto index = VectorIndex::open(states().index_path, *states().before, kRetriever);
    state.ResumeTiming();
    if (index.follow(*states().after).added != kNew) {
      state.SkipWithError("the new clips were not added");
    }
  }
}

/// What a search pays at its start: reading the base, checking it, following.
void index_open(benchmark::State& state) {
  update_index(states().index_path, *states().after, kRetriever);
  for (auto _ : state) {
    benchmark::DoNotOptimize(VectorIndex::open(states().index_path, *states().after, kRetriever));
  }
}

BENCHMARK(index_rebuild)->Apply(with_medians);
BENCHMARK(index_update_files)->Apply(with_medians);
// What is not timed takes longer than what is: few iterations.
BENCHMARK(index_follow)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Repetitions(7)
    ->ReportAggregatesOnly(true)
    ->Iterations(3);
BENCHMARK(index_open)->Apply(with_medians);

}  // namespace
}  // namespace remomask
