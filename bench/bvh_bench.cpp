// Loading a BVH file of 4,000 frames, from the file to canonical positions, on
// one core. Floor: one pass of std::from_chars over the numbers of the same text
// in memory. The floor of that pass is reading its bytes at the memory's rate.

#include <benchmark/benchmark.h>
#include <omp.h>

#include <charconv>
#include <chrono>
#include <filesystem>
#include <limits>
#include <string>

#include "base/file.h"
#include "bench/long_walk.h"
#include "bench/machine_peak.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"

namespace remomask {
namespace {

constexpr int kFrames = 4000;

/// A file that is removed when the program ends.
class TemporaryBvh {
 public:
  TemporaryBvh() {
    std::string folder = (std::filesystem::temp_directory_path() / "bvh_bench_XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) throw Error("cannot make a folder like " + folder);
    folder_ = folder;
    save_motion(path(), long_walk(kFrames));
    text_ = read_file(path());
  }
  ~TemporaryBvh() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  TemporaryBvh(const TemporaryBvh&) = delete;
  TemporaryBvh& operator=(const TemporaryBvh&) = delete;

  std::string path() const { return (folder_ / "walk.bvh").string(); }
  const std::string& text() const { return text_; }

 private:
  std::filesystem::path folder_;
  std::string text_;
};

const TemporaryBvh& walk_file() {
  static const TemporaryBvh file;
  return file;
}

/// Sum of all numbers after the line "Frame Time:".
double sum_of_numbers(const std::string& text) {
  const char* const end = text.data() + text.size();
  const char* p = text.data() + text.find('\n', text.find("Frame Time:"));
  double sum = 0;
  while (p < end) {
    double value = 0;
    const auto [next, error] = std::from_chars(p, end, value);
    if (error == std::errc()) {
      sum += value;
      p = next;
    } else {
      ++p;  // a blank or a line end
    }
  }
  return sum;
}

double min_seconds_of_from_chars() {
  double least = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < 9; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(sum_of_numbers(walk_file().text()));
    least = std::min(
        least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return least;
}

void count_text(benchmark::State& state) {
  state.SetBytesProcessed(state.iterations() * static_cast<int64_t>(walk_file().text().size()));
  state.SetItemsProcessed(state.iterations() * kFrames);
}

void load_bvh(benchmark::State& state) {
  omp_set_num_threads(1);
  const std::string path = walk_file().path();
  static const double floor_seconds = min_seconds_of_from_chars();
  for (auto _ : state) benchmark::DoNotOptimize(load_motion(path));
  count_text(state);
  report_floor(state, floor_seconds);
}

void from_chars_pass(benchmark::State& state) {
  omp_set_num_threads(1);
  const std::string& text = walk_file().text();
  for (auto _ : state) benchmark::DoNotOptimize(sum_of_numbers(text));
  count_text(state);
  report_floor(state, static_cast<double>(text.size()) / memory_read_rate());
}

BENCHMARK(load_bvh)->Apply(with_medians);
BENCHMARK(from_chars_pass)->Apply(with_medians);

}  // namespace
}  // namespace remomask
