#include "training/trainer.h"

#include <torch/nn/module.h>
#include <torch/nn/utils/clip_grad.h>
#include <torch/optim/adamw.h>
#include <torch/utils.h>
#include <torch/version.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

#include "base/json.h"
#include "base/random.h"
#include "remomask/error.h"

namespace remomask::training {

namespace {

/// The key of a parameter in the state of an optimizer: a text in libtorch 1, an address in 2.
auto state_key(const at::Tensor& parameter) {
#if TORCH_VERSION_MAJOR < 2
  return c10::guts::to_string(parameter.unsafeGetTensorImpl());
#else
  return static_cast<void*>(parameter.unsafeGetTensorImpl());
#endif
}

}  // namespace

double scheduled_rate(const TrainerOptions& options, int64_t step) {
  if (step < options.warmup_steps) {
    return options.learning_rate * static_cast<double>(step + 1) /
           static_cast<double>(options.warmup_steps);
  }
  const double span =
      static_cast<double>(std::max<int64_t>(1, options.steps - options.warmup_steps));
  const double phase = std::min(1.0, static_cast<double>(step - options.warmup_steps) / span);
  const double cosine = 0.5 * (1 + std::cos(std::numbers::pi * phase));
  return options.learning_rate * (options.final_rate + (1 - options.final_rate) * cosine);
}

namespace {

constexpr const char* kCheckpointFormat = "remomask-checkpoint";

}  // namespace

struct Trainer::Impl {
  struct TrainedParameter {
    std::string name;
    at::Tensor value, average;
  };

  torch::nn::Module& module;
  TrainerOptions options;
  nlohmann::json config;
  std::vector<TrainedParameter> parameters;
  std::unique_ptr<torch::optim::AdamW> optimizer;
  int64_t step = 0;
  double smooth_loss = 0;  ///< part of the history's figures, so it outlives an interruption
  nlohmann::json history = nlohmann::json::array();
  int64_t validation_every = 0;
  ValidationFunction validation;
  std::function<void(int64_t)> after_step;

  Impl(torch::nn::Module& trained, const TrainerOptions& chosen, const nlohmann::json& identity)
      : module(trained), options(chosen) {
    config = {{"stage", options.stage_name},
              {"steps", options.steps},
              {"learning_rate", options.learning_rate},
              {"warmup_steps", options.warmup_steps},
              {"seed", options.seed},
              {"weight_decay", options.weight_decay},
              {"ema_decay", options.ema_decay},
              {"run", identity}};
    std::vector<at::Tensor> values;
    for (auto& item : module.named_parameters()) {
      if (!item.value().requires_grad()) continue;
      parameters.push_back({item.key(), item.value(), item.value().detach().clone()});
      values.push_back(item.value());
    }
    optimizer = std::make_unique<torch::optim::AdamW>(
        values, torch::optim::AdamWOptions(options.learning_rate)
                    .betas({options.beta1, options.beta2})
                    .weight_decay(options.weight_decay));
    if (!options.checkpoint_path.empty() && std::filesystem::exists(options.checkpoint_path)) {
      load_checkpoint();
    }
  }

  torch::optim::AdamWParamState* moments(const at::Tensor& value) {
    auto& states = optimizer->state();
    const auto found = states.find(state_key(value));
    return found == states.end() ? nullptr
                                 : static_cast<torch::optim::AdamWParamState*>(found->second.get());
  }

  void save_checkpoint() {
    if (options.checkpoint_path.empty()) return;
    nn::TensorMap tensors;
    for (const auto& [name, tensor] : nn::module_tensors(module))
      tensors["module/" + name] = tensor;
    for (auto& parameter : parameters) {
      tensors["average/" + parameter.name] = parameter.average;
      if (const auto* state = moments(parameter.value)) {
        tensors["moment1/" + parameter.name] = state->exp_avg();
        tensors["moment2/" + parameter.name] = state->exp_avg_sq();
        tensors["count/" + parameter.name] = torch::full({1}, state->step(), torch::kLong);
      }
    }
    nn::save_safetensors(options.checkpoint_path, tensors,
                         {{"format", kCheckpointFormat},
                          {"config", config.dump()},
                          {"step", std::to_string(step)},
                          {"smooth_loss", nlohmann::json(smooth_loss).dump()},
                          {"history", history.dump()}});
  }

  void load_checkpoint() {
    try {
      read_checkpoint();
    } catch (const nlohmann::json::exception& error) {
      throw FileError(options.checkpoint_path, 0,
                      "the checkpoint is damaged (" + json_reason(error) +
                          "); remove it to train this stage again from its start");
    } catch (const std::logic_error&) {  // std::stoll of a damaged step
      throw FileError(options.checkpoint_path, 0,
                      "the checkpoint is damaged (its step is no number); remove it to train this "
                      "stage again from its start");
    }
  }

  void read_checkpoint() {
    nn::TensorFile file = nn::load_safetensors(options.checkpoint_path);
    if (file.metadata["format"] != kCheckpointFormat) {
      throw FileError(options.checkpoint_path, 0, "is not a training checkpoint");
    }
    if (parse_json(file.metadata["config"]) != config) {
      throw FileError(options.checkpoint_path, 0,
                      "belongs to a run with other options or data; remove it to start anew, or "
                      "use the options it was made with");
    }
    at::NoGradGuard no_grad;
    nn::TensorMap module_part;
    for (const auto& [name, tensor] : file.tensors) {
      if (name.rfind("module/", 0) == 0) module_part[name.substr(7)] = tensor;
    }
    nn::load_module_tensors(module, module_part, options.checkpoint_path);
    for (auto& parameter : parameters) {
      const auto need = [&](const std::string& prefix) -> at::Tensor {
        const auto found = file.tensors.find(prefix + parameter.name);
        if (found == file.tensors.end()) {
          throw FileError(options.checkpoint_path, 0, "lacks " + prefix + parameter.name);
        }
        return found->second;
      };
      parameter.average.copy_(need("average/"));
      if (file.tensors.count("count/" + parameter.name) == 0) continue;
      auto state = std::make_unique<torch::optim::AdamWParamState>();
      state->step(need("count/").item<int64_t>());
      state->exp_avg(need("moment1/").to(parameter.value.device()));
      state->exp_avg_sq(need("moment2/").to(parameter.value.device()));
      optimizer->state()[state_key(parameter.value)] = std::move(state);
    }
    step = std::stoll(file.metadata["step"]);
    smooth_loss = parse_json(file.metadata["smooth_loss"]).get<double>();
    history = parse_json(file.metadata["history"]);
  }

  void exchange_averages() {
    if (options.ema_decay <= 0) return;
    at::NoGradGuard no_grad;
    for (auto& parameter : parameters) {
      const at::Tensor kept = parameter.value.detach().clone();
      parameter.value.copy_(parameter.average);
      parameter.average.copy_(kept);
    }
  }

  void update_averages() {
    if (options.ema_decay <= 0) return;
    at::NoGradGuard no_grad;
    // Short runs would otherwise keep much of the initial weights.
    const double decay = std::min(
        options.ema_decay, (1.0 + static_cast<double>(step)) / (10.0 + static_cast<double>(step)));
    for (auto& parameter : parameters) parameter.average.lerp_(parameter.value, 1 - decay);
  }

  double one_step(const StepFunction& step_function, std::map<std::string, double>& figures) {
    torch::manual_seed(mix_seed(options.seed, static_cast<uint64_t>(step), 0x7261));
    for (auto& group : optimizer->param_groups()) {
      group.options().set_lr(scheduled_rate(options, step));
    }
    module.train();
    StepResult result = step_function(step);
    const double loss = result.loss.item<double>();
    if (!std::isfinite(loss)) {
      throw Error("training " + options.stage_name + ": the loss is not finite at step " +
                  std::to_string(step) + "; lower the learning rate");
    }
    optimizer->zero_grad();
    result.loss.backward();
    if (options.clip_norm > 0) {
      std::vector<at::Tensor> values;
      for (auto& parameter : parameters) values.push_back(parameter.value);
      torch::nn::utils::clip_grad_norm_(values, options.clip_norm);
    }
    optimizer->step();
    update_averages();
    if (after_step) {
      at::NoGradGuard no_grad;
      after_step(step);
    }
    figures = result.figures;
    return loss;
  }
};

Trainer::Trainer(torch::nn::Module& module, const TrainerOptions& options,
                 const nlohmann::json& config)
    : impl_(std::make_unique<Impl>(module, options, config)) {}

Trainer::~Trainer() = default;

void Trainer::set_validation(int64_t every, ValidationFunction function) {
  impl_->validation_every = every;
  impl_->validation = std::move(function);
}

void Trainer::set_after_step(std::function<void(int64_t)> function) {
  impl_->after_step = std::move(function);
}

int64_t Trainer::step() const { return impl_->step; }

const nlohmann::json& Trainer::history() const { return impl_->history; }

void Trainer::run(const StepFunction& step_function, const Monitor& monitor) {
  using Clock = std::chrono::steady_clock;
  auto saved = Clock::now(), reported = saved - std::chrono::hours(1);
  Impl& self = *impl_;
  const auto seconds_since = [](Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
  };
  while (self.step < self.options.steps) {
    if (monitor.stop_requested()) {
      self.save_checkpoint();
      throw Interrupted("training " + self.options.stage_name + " stopped at step " +
                        std::to_string(self.step) + " of " + std::to_string(self.options.steps) +
                        (self.options.checkpoint_path.empty()
                             ? std::string()
                             : "; the same command goes on from there"));
    }
    std::map<std::string, double> figures;
    const double loss = self.one_step(step_function, figures);
    self.smooth_loss = self.step == 0 ? loss : 0.98 * self.smooth_loss + 0.02 * loss;
    ++self.step;
    const bool last = self.step == self.options.steps;
    if (self.validation && (self.step % self.validation_every == 0 || last)) {
      self.exchange_averages();
      self.module.eval();
      {
        at::NoGradGuard no_grad;
        nlohmann::json entry = self.validation(self.step);
        entry["step"] = self.step;
        entry["loss"] = self.smooth_loss;
        self.history.push_back(entry);
      }
      self.exchange_averages();
    }
    if (last || seconds_since(saved) > self.options.checkpoint_seconds) {
      self.save_checkpoint();
      saved = Clock::now();
    }
    if (last || seconds_since(reported) > 1.0) {
      reported = Clock::now();
      std::string detail = "loss " + std::to_string(self.smooth_loss);
      for (const auto& [name, value] : figures) detail += "  " + name + " " + std::to_string(value);
      if (!self.history.empty()) detail += "  last validation " + self.history.back().dump();
      monitor.report({"train " + self.options.stage_name, static_cast<double>(self.step),
                      static_cast<double>(self.options.steps), detail});
    }
  }
  self.exchange_averages();
  self.module.eval();
}

}  // namespace remomask::training
