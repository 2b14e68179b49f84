// 1,000 clips that are new, removed, or described anew (their vectors dropped and
// made again) beside an index of 67,000: what it costs to take that over, beside
// building the whole index anew from the stored vectors (width 512). Embedding is
// not part of either.

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <optional>

#include "bench/machine_peak.h"
#include "bench/unit_vectors.h"
#include "db/transaction.h"
#include "index/index_changes.h"
#include "index/update_index.h"

namespace remomask {
namespace {

constexpr int kBefore = 67000, kNew = 1000, kWidth = 512;
constexpr const char* kRetriever = "0123456789abcdef0123456789abcdef";

void add_clips(db::Database& database, int first, int count) {
  const auto vectors = random_unit_vectors(count, kWidth, static_cast<uint64_t>(first));
  std::vector<db::ClipEmbedding> embeddings;
  db::Transaction transaction(database);
  for (int i = 0; i < count; ++i) {
    db::Clip clip;
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
  transaction.commit();
}

/// Changes that a database can go through beside its index.
struct Change {
  const char* name;
  index::IndexDifference expected;
  void (*apply)(db::Database& database);
};

std::vector<int64_t> every_67th(const db::Database& database) {
  const auto ids = database.embedded_clips(kRetriever);
  std::vector<int64_t> some;
  for (size_t i = 0; i < ids.size(); i += kBefore / kNew) some.push_back(ids[i]);
  return some;
}

const Change kAdded{
    "added", {kNew, 0}, [](db::Database& database) { add_clips(database, kBefore, kNew); }};
const Change kRemoved{
    "removed", {0, kNew}, [](db::Database& database) { database.remove(every_67th(database)); }};
const Change kDescribed{"described", {0, 0}, [](db::Database& database) {
                          const auto ids = every_67th(database);
                          const auto vectors = database.embeddings(kRetriever, ids);
                          db::Transaction transaction(database);
                          for (const int64_t id : ids) {
                            db::ClipChanges captions;
                            captions.captions = {"a person does number " + std::to_string(-id)};
                            database.update_clip(id, captions);
                          }
                          database.add_embeddings(kRetriever, vectors);
                          transaction.commit();
                        }};

/// A database, its index, and copies of it that have changed.
struct States {
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("index_bench_" + std::to_string(getpid()));
  std::string index_path = (folder / "motions.index").string();
  std::optional<db::Database> before;
  std::map<std::string, db::Database> after;  ///< Change::name ->

  States() {
    std::filesystem::create_directories(folder);
    const std::string early = (folder / "before.sqlite").string();
    {
      db::Database database(early, db::OpenMode::create);
      add_clips(database, 0, kBefore);
    }
    before.emplace(early, db::OpenMode::read_only);
    for (const Change* change : {&kAdded, &kRemoved, &kDescribed}) {
      const std::string late = (folder / change->name).string();
      std::filesystem::copy_file(early, late);
      change->apply(after.try_emplace(change->name, late, db::OpenMode::read_write).first->second);
    }
    index::update_index(index_path, *before, kRetriever);
  }
  ~States() {
    before.reset();
    after.clear();
    std::filesystem::remove_all(folder);
  }
};

States& states() {
  static States all;
  return all;
}

bool is_expected(const index::IndexDifference& difference, const Change& change) {
  return difference.added == change.expected.added && difference.dropped == change.expected.dropped;
}

void index_rebuild(benchmark::State& state) {
  const std::string path = (states().folder / "rebuilt.index").string();
  index::UpdateOptions options;
  options.rebuild = true;
  for (auto _ : state) index::update_index(path, states().after.at("added"), kRetriever, options);
}

/// What `remomask index` does after embedding: from the files to the files.
void index_update_files(benchmark::State& state, const Change& change) {
  const db::Database& after = states().after.at(change.name);
  for (auto _ : state) {
    state.PauseTiming();
    std::filesystem::remove(index::delta_path(states().index_path));
    state.ResumeTiming();
    const index::IndexUpdate made = index::update_index(states().index_path, after, kRetriever);
    if (!is_expected(made.difference, change)) state.SkipWithError("the wrong clips have changed");
  }
}

/// An open index takes the new state over.
void index_follow(benchmark::State& state, const Change& change) {
  const db::Database& after = states().after.at(change.name);
  std::filesystem::remove(index::delta_path(states().index_path));
  for (auto _ : state) {
    state.PauseTiming();
    auto index = index::VectorIndex::open(states().index_path, *states().before, kRetriever);
    state.ResumeTiming();
    const index::IndexDifference difference = index.follow(after);
    if (!is_expected(difference, change)) state.SkipWithError("the wrong clips have changed");
  }
}

/// What a search pays at its start: reading the base, checking it, following.
void index_open(benchmark::State& state) {
  const db::Database& after = states().after.at("added");
  index::update_index(states().index_path, after, kRetriever);
  for (auto _ : state) {
    benchmark::DoNotOptimize(index::VectorIndex::open(states().index_path, after, kRetriever));
  }
}

// The untimed part takes longer than the timed one, so there are few iterations.
void with_few_iterations(benchmark::internal::Benchmark* bench) {
  bench->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->Repetitions(7)
      ->ReportAggregatesOnly(true)
      ->Iterations(3);
}

BENCHMARK(index_rebuild)->Apply(with_medians);
BENCHMARK_CAPTURE(index_update_files, added, kAdded)->Apply(with_medians);
BENCHMARK_CAPTURE(index_update_files, removed, kRemoved)->Apply(with_medians);
BENCHMARK_CAPTURE(index_update_files, described, kDescribed)->Apply(with_medians);
BENCHMARK_CAPTURE(index_follow, added, kAdded)->Apply(with_few_iterations);
BENCHMARK_CAPTURE(index_follow, removed, kRemoved)->Apply(with_few_iterations);
BENCHMARK_CAPTURE(index_follow, described, kDescribed)->Apply(with_few_iterations);
BENCHMARK(index_open)->Apply(with_medians);

}  // namespace
}  // namespace remomask
