// One whole generation of 196 frames from a prompt and as many hits as the model
// takes, with 1, 2 and 4 threads, and what each stage takes of it. The model is
// the file that REMOMASK_MODEL names, else models/base.safetensors, else random
// weights of preset base; the label says which. Floor: the matrix products of
// both transformers and the decoder at the GEMM peak of as many threads.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "base/random.h"
#include "base/time.h"
#include "bench/machine_peak.h"
#include "bench/model_work.h"
#include "bench/random_model.h"
#include "encoders/text_file.h"
#include "nn/model_file.h"
#include "nn/threads.h"
#include "pipeline/motion_generator.h"
#include "remomask/error.h"

namespace remomask {
namespace {

const char* const kPrompt =
    "a person walks forward, then turns around and waves with the left hand";
constexpr double kSeconds = kMaxClipSeconds;

struct BenchModel {
  std::string label;
  std::shared_ptr<const encoders::SentenceEncoder> words;
  std::map<std::string, nn::ModelStage> stages;

  BenchModel() {
    const char* named = std::getenv("REMOMASK_MODEL");
    const std::string path =
        named != nullptr ? named : REMOMASK_SOURCE_DIR "/models/base.safetensors";
    words = std::make_shared<const encoders::SentenceEncoder>(
        encoders::SentenceEncoder::open(encoders::text_file_of(path)));
    if (named != nullptr || std::filesystem::exists(path)) {
      label = std::filesystem::path(path).filename().string();
      stages = nn::load_model(path);
    } else {
      label = "random weights";
      stages = random_stages(training::model_preset(parse_preset("base")), *words);
    }
  }
};

std::vector<pipeline::RetrievedMotion> random_hits(const pipeline::Generator& generator) {
  CounterRandom random(1);
  const auto width = static_cast<size_t>(generator.retriever().embedding_width());
  const auto unit_vector = [&] {
    std::vector<float> vector(width);
    double square = 0;
    for (float& value : vector) {
      value = static_cast<float>(random.uniform(-1, 1));
      square += static_cast<double>(value) * value;
    }
    for (float& value : vector) value /= static_cast<float>(std::sqrt(square));
    return vector;
  };
  std::vector<pipeline::RetrievedMotion> hits(static_cast<size_t>(generator.max_hits()));
  for (pipeline::RetrievedMotion& hit : hits) {
    hit.motion = unit_vector();
    hit.text = unit_vector();
    hit.similarity = 0.5;
  }
  return hits;
}

/// Work of the stages that a generation repeats.
struct GenerationWork {
  double base = 0, residual = 0, decode = 0;
};

GenerationWork generation_work(const BenchModel& model, const pipeline::Generator& generator,
                               const SamplingOptions& options) {
  const auto masked = generator::masked_config(model.stages.at("masked").config);
  const tokenizer::TokenizerConfig& tokenizer = generator.tokenizer().config();
  const ConditionSize condition{generator.retriever().encode_text({kPrompt}).states.size(1),
                                generator.max_hits()};
  GenerationWork work;
  work.base = sample_base_flops(masked, options, condition, kMaxTokenFrames);
  if (tokenizer.levels > 1) {
    work.residual =
        sample_residual_flops(generator::residual_config(model.stages.at("residual").config),
                              options, condition, kMaxTokenFrames);
  }
  work.decode = decode_flops(tokenizer, kMaxTokenFrames);
  return work;
}

void time_generation(benchmark::State& state) {
  static const BenchModel model;
  static const pipeline::Generator generator(model.stages, model.words);
  nn::set_compute_threads(static_cast<int>(state.range(0)));
  state.SetLabel(model.label);
  const auto hits = random_hits(generator);
  GenerateOptions options;
  options.seconds = kSeconds;
  const GenerationWork work = generation_work(model, generator, options.sampling);
  GenerationTimes sum;
  for (auto _ : state) {
    const pipeline::Generated made = generator.generate(kPrompt, hits, options);
    sum.text += made.times.text;
    sum.base += made.times.base;
    sum.residual += made.times.residual;
    sum.decode += made.times.decode;
    sum.finish += made.times.finish;
    ++options.seed;
  }
  const auto stage = [&](const std::string& name, double seconds) {
    state.counters[name + "_ms"] =
        benchmark::Counter(seconds * 1e3, benchmark::Counter::kAvgIterations);
  };
  stage("text", sum.text);
  stage("base", sum.base);
  stage("residual", sum.residual);
  stage("decode", sum.decode);
  stage("finish", sum.finish);
  const auto stage_floor = [&](const std::string& name, double flops) {
    state.counters[name + "_floor_ms"] = flops / gemm_rate() * 1e3;
  };
  stage_floor("base", work.base);
  stage_floor("residual", work.residual);
  stage_floor("decode", work.decode);
  report_arithmetic(state, work.base + work.residual + work.decode);
}

void generate(benchmark::State& state) {
  try {
    time_generation(state);
  } catch (const Error& error) {
    state.SkipWithError(error.what());
  }
}

BENCHMARK(generate)->ArgName("threads")->Arg(1)->Arg(2)->Arg(4)->Apply(with_medians);

}  // namespace
}  // namespace remomask
