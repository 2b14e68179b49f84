// HumanML3D features of 20,000 frames on one core, in both modes. Floor: moving
// the bytes of positions (22 x 3 floats a frame, read) and features (263 floats
// a frame, written) at the rate at which one core reads memory.

#include <benchmark/benchmark.h>
#include <omp.h>

#include "bench/long_walk.h"
#include "bench/machine_peak.h"
#include "motion/features.h"

namespace remomask {
namespace {

constexpr int kFrames = 20000;

void extract(benchmark::State& state, motion::FeatureMode mode) {
  omp_set_num_threads(1);
  static const Motion walk = long_walk(kFrames);
  const Skeleton& skeleton = humanml_skeleton();
  for (auto _ : state) benchmark::DoNotOptimize(motion::extract_features(walk, skeleton, mode));
  const double bytes = 4.0 * kFrames * (skeleton.joints() * 3 + skeleton.feature_dim());
  state.SetItemsProcessed(state.iterations() * kFrames);
  report_floor(state, bytes / memory_read_rate());
}

BENCHMARK_CAPTURE(extract, official, motion::FeatureMode::official)->Apply(with_medians);
BENCHMARK_CAPTURE(extract, fixed, motion::FeatureMode::fixed)->Apply(with_medians);

}  // namespace
}  // namespace remomask
