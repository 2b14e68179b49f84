#include "bench/machine_peak.h"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <vector>

extern "C" void sgemm_(const char* trans_a, const char* trans_b, const int* m, const int* n,
                       const int* k, const float* alpha, const float* a, const int* lda,
                       const float* b, const int* ldb, const float* beta, float* c, const int* ldc);

namespace remomask {

namespace {

constexpr int kPasses = 9;  // the first ones also warm up

template <typename Work>
double min_seconds(const Work& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < kPasses; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    work();
    least = std::min(
        least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return least;
}

double measure_memory_read_rate() {
  const std::vector<float> data(size_t{32} << 20, 1.f);
  const auto count = static_cast<int64_t>(data.size());
  const double seconds = min_seconds([&] {
    const float* values = data.data();
    float sum = 0;
#pragma omp parallel for simd reduction(+ : sum)
    for (int64_t i = 0; i < count; ++i) sum += values[i];
    benchmark::DoNotOptimize(sum);
  });
  return static_cast<double>(count) * sizeof(float) / seconds;
}

double measure_gemm_rate() {
  constexpr int kSize = 1024;
  const std::vector<float> a(size_t{kSize} * kSize, 0.5f), b(a.size(), 0.25f);
  std::vector<float> c(a.size());
  const float one = 1, zero = 0;
  const double seconds = min_seconds([&] {
    sgemm_("N", "N", &kSize, &kSize, &kSize, &one, a.data(), &kSize, b.data(), &kSize, &zero,
           c.data(), &kSize);
    benchmark::DoNotOptimize(c.data());
  });
  return 2.0 * kSize * kSize * kSize / seconds;
}

template <typename Measure>
double once_for_each_thread_count(std::map<int, double>& known, const Measure& measure) {
  const int threads = omp_get_max_threads();
  const auto found = known.find(threads);
  if (found != known.end()) return found->second;
  return known[threads] = measure();
}

}  // namespace

double memory_read_rate() {
  static std::map<int, double> known;
  return once_for_each_thread_count(known, measure_memory_read_rate);
}

double gemm_rate() {
  static std::map<int, double> known;
  return once_for_each_thread_count(known, measure_gemm_rate);
}

void report_floor(benchmark::State& state, double floor_seconds) {
  using benchmark::Counter;
  state.counters["floor_ms"] = floor_seconds * 1e3;
  state.counters["x_floor"] =
      Counter(floor_seconds, Counter::Flags(Counter::kIsIterationInvariantRate | Counter::kInvert));
}

void report_arithmetic(benchmark::State& state, double flops) {
  using benchmark::Counter;
  state.counters["FLOP"] = Counter(flops, Counter::kIsIterationInvariantRate);
  state.counters["peak_FLOP/s"] = gemm_rate();
  report_floor(state, flops / gemm_rate());
}

void with_medians(benchmark::internal::Benchmark* bench) {
  bench->Unit(benchmark::kMillisecond)
      ->UseRealTime()
      ->MinWarmUpTime(0.2)
      ->Repetitions(7)
      ->ReportAggregatesOnly(true);
}

}  // namespace remomask
