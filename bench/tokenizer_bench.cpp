// The tokenizer of preset base (random weights) on 196 frames: features to
// tokens and back. Floor: its matrix products at the GEMM peak of as many threads.

#include <benchmark/benchmark.h>
#include <torch/types.h>

#include "base/machine.h"
#include "base/time.h"
#include "bench/long_walk.h"
#include "bench/machine_peak.h"
#include "bench/model_work.h"
#include "bench/random_model.h"
#include "generator/ssta.h"
#include "nn/threads.h"
#include "tokenizer/tokenizer_network.h"

namespace remomask {
namespace {

constexpr int kFrames = static_cast<int>(kMaxTokenFrames * kFramesPerToken);

const tokenizer::Tokenizer& base_tokenizer() {
  static const tokenizer::Tokenizer tokenizer = [] {
    torch::manual_seed(1);
    return tokenizer::Tokenizer(
        random_tokenizer_stage(training::model_preset(parse_preset("base")).tokenizer));
  }();
  return tokenizer;
}

void encode(benchmark::State& state) {
  nn::set_compute_threads(static_cast<int>(state.range(0)));
  const tokenizer::Tokenizer& tokenizer = base_tokenizer();
  const motion::Features features = motion::extract_features_all_frames(
      long_walk(kFrames), humanml_skeleton(), motion::FeatureMode::fixed);
  for (auto _ : state) benchmark::DoNotOptimize(tokenizer.encode(features));
  state.SetItemsProcessed(state.iterations() * kFrames);
  report_arithmetic(state, encode_flops(tokenizer.config(), kMaxTokenFrames));
}

void decode(benchmark::State& state) {
  nn::set_compute_threads(static_cast<int>(state.range(0)));
  const tokenizer::Tokenizer& tokenizer = base_tokenizer();
  const tokenizer::TokenizerConfig& config = tokenizer.config();
  const at::Tensor tokens =
      torch::randint(config.codes, {kMaxTokenFrames, config.rows, config.levels}, torch::kLong);
  for (auto _ : state) benchmark::DoNotOptimize(tokenizer.decode(tokens));
  state.SetItemsProcessed(state.iterations() * kFrames);
  report_arithmetic(state, decode_flops(config, kMaxTokenFrames));
}

void one_and_all_threads(benchmark::internal::Benchmark* bench) {
  bench->ArgName("threads")->Arg(1);
  if (available_cpus() > 1) bench->Arg(available_cpus());
}

BENCHMARK(encode)->Apply(one_and_all_threads)->Apply(with_medians);
BENCHMARK(decode)->Apply(one_and_all_threads)->Apply(with_medians);

}  // namespace
}  // namespace remomask
