// Training steps of preset base, each network as `remomask train` trains it (loss,
// gradients, AdamW, weight averaging, momentum twins, queues, codebooks), on the
// training clips of the database that REMOMASK_DATABASE names (else
// models/motions.sqlite), with 1 thread and with all. Floor: the matrix products and
// convolutions of the same steps at the GEMM peak of as many threads. Read the counters:
// one iteration is a whole short training.

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "base/machine.h"
#include "bench/file_named.h"
#include "bench/flop_counter.h"
#include "bench/machine_peak.h"
#include "nn/threads.h"
#include "training/evaluator_training.h"
#include "training/model_training.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

const training::TrainingSplits& training_clips() {
  static const training::TrainingSplits splits = [] {
    const db::Database database(file_named("REMOMASK_DATABASE", "motions.sqlite"),
                                db::OpenMode::read_only);
    return training::TrainingSplits{db::load_training_set(database, {}),
                                    {}};  // no val: steps alone
  }();
  return splits;
}

/// Folder of the stages that were trained so far; later ones build on them.
class StageFolder {
 public:
  StageFolder() { fs::create_directories(path_); }
  ~StageFolder() { fs::remove_all(path_); }
  std::string file(const std::string& stage) const {
    return (path_ / (stage + ".safetensors")).string();
  }

 private:
  fs::path path_ = fs::temp_directory_path() / ("remomask-bench-" + std::to_string(getpid()));
};

/// What happened between two reports of a training, which arrive once a second.
class StepMeter {
 public:
  explicit StepMeter(std::string stage) : stage_("train " + std::move(stage)) {}

  Monitor monitor() {
    return {[this](const Progress& progress) { note(progress); }, {}};
  }
  double steps() const { return last_.steps - first_.steps; }
  double seconds() const { return std::chrono::duration<double>(last_.time - first_.time).count(); }
  double flops() const { return last_.flops - first_.flops; }

 private:
  struct Mark {
    double steps = 0, flops = 0;
    std::chrono::steady_clock::time_point time;
  };

  void note(const Progress& progress) {
    if (progress.stage != stage_) return;
    const Mark mark{progress.done, counter_.count(), std::chrono::steady_clock::now()};
    // The first steps warm caches up; the last report waits for the file.
    if (progress.done < kWarmSteps) {
      first_ = last_ = mark;
    } else if (progress.done < progress.total) {
      last_ = mark;
    }
  }

  static constexpr double kWarmSteps = 4;
  std::string stage_;
  FlopCounter counter_;
  Mark first_, last_;
};

void train_evaluator_steps(int64_t steps, const Monitor& monitor) {
  training::EvaluatorTrainingOptions options(ModelSize::base);
  options.movement.steps = 1;
  options.trainer.steps = steps;
  training::train_evaluator(training_clips().train, {},
                            evaluation::evaluator_preset(ModelSize::base), options, monitor);
}

/// Trains a stage and, before it, for one step each, the missing stages that it builds on.
void train_stage_steps(const std::string& stage, int64_t steps, const Monitor& monitor) {
  static const StageFolder folder;
  static training::GeneratorDataCache prepared;
  const training::StageFile file = [](const std::string& each) { return folder.file(each); };
  training::TrainingRecipe recipe = training::training_recipe(parse_preset("base"));
  for (const std::string& earlier : training::recipe_stages(recipe)) {
    if (earlier == stage) break;
    if (fs::exists(file(earlier))) continue;
    training::set_stage_steps(recipe, earlier, 1);
    training::train_stage(recipe, earlier, file, training_clips(), prepared, {});
  }
  training::set_stage_steps(recipe, stage, steps);
  training::train_stage(recipe, stage, file, training_clips(), prepared, monitor);
}

void train_steps(benchmark::State& state, const std::string& stage, int64_t steps) {
  nn::set_compute_threads(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    StepMeter meter(stage);
    if (stage == "evaluator") {
      train_evaluator_steps(steps, meter.monitor());
    } else {
      train_stage_steps(stage, steps, meter.monitor());
    }
    if (meter.steps() <= 0) throw std::runtime_error("too few steps to measure " + stage);
    const double floor = meter.flops() / gemm_rate();
    state.counters["steps/s"] = meter.steps() / meter.seconds();
    state.counters["GFLOP/step"] = meter.flops() / meter.steps() / 1e9;
    state.counters["floor_steps/s"] = meter.steps() / floor;
    state.counters["times_floor"] = meter.seconds() / floor;
  }
}

void once(benchmark::internal::Benchmark* bench) {
  bench->ArgName("threads")->Iterations(1)->UseRealTime()->Unit(benchmark::kSecond);
  bench->Arg(1);
  if (available_cpus() > 1) bench->Arg(available_cpus());
}

BENCHMARK_CAPTURE(train_steps, retriever, "retriever", 24)->Apply(once);
BENCHMARK_CAPTURE(train_steps, tokenizer, "tokenizer", 60)->Apply(once);
BENCHMARK_CAPTURE(train_steps, masked, "masked", 24)->Apply(once);
BENCHMARK_CAPTURE(train_steps, residual, "residual", 24)->Apply(once);
BENCHMARK_CAPTURE(train_steps, evaluator, "evaluator", 60)->Apply(once);

}  // namespace
}  // namespace remomask
