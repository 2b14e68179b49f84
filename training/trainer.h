#pragma once

#include <ATen/core/Tensor.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "nn/model_file.h"
#include "remomask/progress.h"

namespace remomask::training {

struct TrainerOptions {
  int64_t steps = 1000;
  double learning_rate = 2e-4;
  int64_t warmup_steps = 200;  ///< linear; then cosine to `final_rate` x learning_rate
  double final_rate = 0.05;
  double weight_decay = 1e-5;
  double beta1 = 0.9, beta2 = 0.99;
  double clip_norm = 1.0;    ///< 0: no clipping
  double ema_decay = 0.999;  ///< weight averaging; 0: none
  uint64_t seed = 1;
  std::string checkpoint_path;     ///< empty: no checkpoints
  double checkpoint_seconds = 60;  ///< time between checkpoints
  std::string stage_name;          ///< for progress and errors, "tokenizer"
};

struct StepResult {
  at::Tensor loss;                        ///< scalar with gradient
  std::map<std::string, double> figures;  ///< shown beside the loss
};

/// Runs AdamW over the parameters of a module that require gradients, with
/// warm-up, cosine decay, clipping, weight averaging, checkpoints. A run that
/// is interrupted and started again with the same options gives the same
/// weights as an uninterrupted one: the checkpoint holds parameters, buffers,
/// both Adam moments, the averages and the step, and before step s torch's
/// generator is seeded with (seed, s), so no random state has to be kept. The
/// step function must draw its own randomness from (seed, step) too.
class Trainer {
 public:
  /// `config` identifies the run: a checkpoint of another config is refused
  /// with an Error. Resumes when `checkpoint_path` exists.
  Trainer(torch::nn::Module& module, const TrainerOptions& options, const nlohmann::json& config);
  ~Trainer();

  /// Called with the step that comes next, 0-based.
  using StepFunction = std::function<StepResult(int64_t step)>;
  /// Called every `every` steps (and after the last) with averaged weights in
  /// the module in eval mode; what it returns is shown and kept in history().
  using ValidationFunction = std::function<std::map<std::string, double>(int64_t step)>;
  void set_validation(int64_t every, ValidationFunction function);
  /// Called after each optimiser step in no-grad mode (momentum twins, EMA codebooks).
  void set_after_step(std::function<void(int64_t step)> function);

  /// Trains to the last step and leaves the averaged weights in the module, in
  /// eval mode. Throws Interrupted after writing a checkpoint when the monitor
  /// asks to stop, Error when the loss is not finite.
  void run(const StepFunction& step_function, const Monitor& monitor);

  int64_t step() const;
  /// One entry a validation: {"step": ..., figures...}; part of the checkpoint.
  const nlohmann::json& history() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Learning rate of step s (0-based): linear warm-up, cosine decay.
double scheduled_rate(const TrainerOptions& options, int64_t step);

}  // namespace remomask::training
