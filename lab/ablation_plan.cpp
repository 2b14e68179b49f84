#include "lab/ablation_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "base/hash.h"
#include "lab/ablation_cost.h"
#include "lab/variants.h"
#include "remomask/error.h"

namespace remomask::lab {

namespace {

constexpr size_t kKeyDigits = 16;

std::string key_of(const nlohmann::json& identity) {
  return content_hash(identity.dump()).substr(0, kKeyDigits);
}

/// The stages whose results a stage reads.
std::vector<std::string> stage_inputs(const std::string& stage) {
  if (stage == "masked" || stage == "residual") return {"tokenizer", "retriever"};
  return {};
}

template <typename T>
void check_list(const std::vector<T>& list, const std::string& what) {
  if (list.empty()) throw Error("the ablation needs at least one " + what);
  if (std::set<T>(list.begin(), list.end()).size() != list.size()) {
    throw Error("the ablation's list of " + what + "s names one twice");
  }
}

training::TrainingRecipe ablation_recipe(const AblationOptions& options, const std::string& variant,
                                         uint64_t seed) {
  training::TrainingRecipe recipe = training::training_recipe(parse_preset(options.preset));
  apply_variant(recipe, variant);
  for (const std::string& stage : training::recipe_stages(recipe)) {
    training::TrainerOptions& trainer = training::stage_trainer(recipe, stage);
    const auto steps = options.steps.find(stage);
    training::set_stage_steps(recipe, stage,
                              steps == options.steps.end() ? trainer.steps : steps->second);
    const auto batch = options.batch.find(stage);
    if (batch != options.batch.end()) training::set_stage_batch(recipe, stage, batch->second);
    trainer.seed = stage == "tokenizer" ? options.seeds.front() : seed;
  }
  // Only the final figures are compared; intermediate ones would cost as much as training a small
  // model.
  recipe.retriever_training.validation_every = recipe.retriever_training.trainer.steps;
  recipe.tokenizer_training.validate_every = recipe.tokenizer_training.trainer.steps;
  recipe.masked_training.validate_every = recipe.masked_training.trainer.steps;
  recipe.residual_training.validate_every = recipe.residual_training.trainer.steps;
  return recipe;
}

AblationModel plan_model(const AblationOptions& options, const std::string& variant, uint64_t seed,
                         const AblationData& data) {
  AblationModel model{variant, seed, ablation_recipe(options, variant, seed), {}};
  const std::filesystem::path folder = std::filesystem::path(options.folder) / "stages";
  for (const std::string& stage : training::recipe_stages(model.recipe)) {
    nlohmann::json identity = training::stage_description(model.recipe, stage);
    // A preset is a name for sizes that the description contains anyway.
    identity["config"].erase("preset");
    identity["data"] = data.training;
    for (const std::string& input : stage_inputs(stage)) {
      identity["inputs"].push_back(
          std::filesystem::path(model.files.at(input)).filename().string());
    }
    model.files[stage] = (folder / (stage + "-" + key_of(identity) + ".safetensors")).string();
  }
  return model;
}

AblationTrial plan_trial(const AblationOptions& options, const AblationPlan& plan, size_t model,
                         const std::string& sweep, const SamplingOptions& sampling,
                         const AblationData& data) {
  nlohmann::json identity = {{"sampling", sampling_description(sampling)},
                             {"prompts", options.prompts},
                             {"split", options.split},
                             {"prompt_seed", options.prompt_seed},
                             {"exam", data.exam}};
  for (const auto& [stage, file] : plan.models[model].files) {
    identity["stages"].push_back(std::filesystem::path(file).filename().string());
  }
  const auto name = "trial-" + key_of(identity) + ".json";
  return {model, sweep, sampling,
          (std::filesystem::path(options.folder) / "trials" / name).string()};
}

std::string trial_title(const AblationModel& model, const AblationTrial& trial) {
  std::string how;
  if (trial.sweep == "guidance") how = fmt::format(" at guidance {:g}", trial.sampling.guidance);
  if (trial.sweep == "steps") how = fmt::format(" in {} steps", trial.sampling.steps);
  return fmt::format("trial of {}, seed {}{}", model.variant, model.seed, how);
}

/// Models one after the other, with those on the same tokenizer and retriever together, so that
/// their training data is prepared once.
std::vector<size_t> working_order(const std::vector<AblationModel>& models) {
  const auto base = [&](size_t i) {
    return models[i].files.at("tokenizer") + models[i].files.at("retriever");
  };
  std::vector<size_t> order;
  std::set<size_t> taken;
  for (size_t i = 0; i < models.size(); ++i) {
    for (size_t j = i; j < models.size(); ++j) {
      if (base(j) == base(i) && taken.insert(j).second) order.push_back(j);
    }
  }
  return order;
}

}  // namespace

nlohmann::json sampling_description(const SamplingOptions& sampling) {
  return {{"steps", sampling.steps},
          {"guidance", sampling.guidance},
          {"temperature", sampling.temperature},
          {"top_share", sampling.top_share},
          {"score_noise", sampling.score_noise},
          {"correction_rounds", sampling.correction_rounds},
          {"residual_guidance", sampling.residual_guidance},
          {"residual_temperature", sampling.residual_temperature}};
}

AblationPlan plan_ablation(const AblationOptions& options, const AblationData& data) {
  check_list(options.variants, "variant");
  check_list(options.seeds, "seed");
  if (options.prompts < 1) throw Error("the ablation needs at least one prompt");
  const training::TrainingRecipe known = training::training_recipe(parse_preset(options.preset));
  for (const auto* choices : {&options.steps, &options.batch}) {
    for (const auto& [stage, value] : *choices) {
      training::stage_trainer(known, stage);  // refuses unknown stages
      if (value < 1) throw Error("steps and batch of " + stage + " must be positive");
    }
  }
  AblationPlan plan;
  for (const uint64_t seed : options.seeds) {
    for (const std::string& variant : options.variants) {
      plan.models.push_back(plan_model(options, variant, seed, data));
    }
  }
  for (size_t i = 0; i < plan.models.size(); ++i) {
    plan.trials.push_back(plan_trial(options, plan, i, "", plan.models[i].recipe.sampling, data));
  }
  for (const double guidance : options.guidance_sweep) {
    if (!plan.models.front().recipe.model.masked.drops_conditions) {
      throw Error("the guidance of " + options.variants.front() +
                  " cannot be swept: it is trained without guidance; name another variant first");
    }
    SamplingOptions sampling = plan.models.front().recipe.sampling;
    sampling.guidance = guidance;
    plan.trials.push_back(plan_trial(options, plan, 0, "guidance", sampling, data));
  }
  for (const int steps : options.steps_sweep) {
    SamplingOptions sampling = plan.models.front().recipe.sampling;
    sampling.steps = steps;
    plan.trials.push_back(plan_trial(options, plan, 0, "steps", sampling, data));
  }
  std::set<std::string> planned;
  for (const size_t number : working_order(plan.models)) {
    const AblationModel& model = plan.models[number];
    for (const std::string& stage : training::recipe_stages(model.recipe)) {
      const std::string& file = model.files.at(stage);
      if (!planned.insert(file).second) continue;
      plan.jobs.push_back({stage, number, file,
                           fmt::format("{} of {}, seed {}", stage, model.variant, model.seed),
                           training_cost(model.recipe, stage)});
    }
    for (size_t i = 0; i < plan.trials.size(); ++i) {
      const AblationTrial& trial = plan.trials[i];
      if (trial.model != number || !planned.insert(trial.file).second) continue;
      plan.jobs.push_back({"trial", i, trial.file, trial_title(model, trial),
                           trial_cost(model.recipe, trial.sampling, options.prompts)});
    }
  }
  return plan;
}

}  // namespace remomask::lab
