// The attention stack of preset base (random weights) on maps of 49 x 6 tokens
// with 16 text tokens and 4 hits, forward alone and with its gradients. Floor:
// the matrix products at the GEMM peak of as many threads; backward counts as
// two forward passes.

#include <benchmark/benchmark.h>
#include <torch/types.h>

#include "base/machine.h"
#include "base/time.h"
#include "bench/machine_peak.h"
#include "bench/model_work.h"
#include "nn/threads.h"
#include "training/presets.h"

namespace remomask {
namespace {

constexpr ConditionSize kCondition{16, 4};

generator::Condition random_unit_condition(const generator::SstaConfig& config, int64_t batch) {
  const auto unit = [&](std::vector<int64_t> shape) {
    const auto x = torch::randn(shape);
    return x / x.norm(2, -1, /*keepdim=*/true);
  };
  const int64_t text = kCondition.text_tokens, hits = kCondition.hits;
  const int64_t width = config.embedding_width;
  return {torch::randn({batch, text, config.text_width}),
          torch::ones({batch, text}, torch::kBool),
          unit({batch, width}),
          unit({batch, hits, width}),
          unit({batch, hits, width}),
          torch::rand({batch, hits}),
          torch::ones({batch, hits}, torch::kBool),
          torch::zeros({batch, 0, 0, config.rows}, torch::kLong),  // hits are vectors only
          torch::ones({batch}, torch::kBool),
          torch::ones({batch}, torch::kBool)};
}

void run_stack(benchmark::State& state, bool with_gradients) {
  const int64_t batch = state.range(0);
  nn::set_compute_threads(static_cast<int>(state.range(1)));
  torch::manual_seed(1);
  const generator::MaskedConfig model = training::model_preset(parse_preset("base")).masked;
  const generator::SstaConfig config = stack_config(model);
  generator::SstaStack stack(config, model.layers);
  stack->initialise();
  stack->train(with_gradients);
  const generator::Condition condition = random_unit_condition(config, batch);
  auto x = torch::randn({batch, kMaxTokenFrames * config.rows, config.width});
  x.requires_grad_(with_gradients);
  const torch::AutoGradMode gradients(with_gradients);
  for (auto _ : state) {
    const auto y = stack->forward(x, stack->prepare(condition), /*frame_mask=*/{});
    if (with_gradients) {
      stack->zero_grad();
      y.sum().backward();
    }
    benchmark::DoNotOptimize(y.data_ptr<float>());
  }
  const double forward =
      static_cast<double>(batch) * (prepare_flops(config, model.layers, kCondition) +
                                    stack_flops(config, model.layers, kCondition, kMaxTokenFrames));
  state.SetItemsProcessed(state.iterations() * batch);
  report_arithmetic(state, with_gradients ? 3 * forward : forward);
}

void batches_and_threads(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"batch", "threads"});
  for (const int64_t batch : {1, 16}) {
    bench->Args({batch, 1});
    if (available_cpus() > 1) bench->Args({batch, available_cpus()});
  }
}

BENCHMARK_CAPTURE(run_stack, forward, false)->Apply(batches_and_threads)->Apply(with_medians);
BENCHMARK_CAPTURE(run_stack, forward_backward, true)
    ->Apply(batches_and_threads)
    ->Apply(with_medians);

}  // namespace
}  // namespace remomask
