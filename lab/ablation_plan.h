#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "training/training_recipe.h"

namespace remomask::lab {

/// What an ablation compares. Every variant gets the same steps, batches, seeds,
/// clips, prompts and judge.
struct AblationOptions {
  std::string folder;
  std::string preset = "tiny";
  std::vector<std::string> variants;     ///< see variants.h
  std::vector<uint64_t> seeds = {1};     ///< of retriever and transformers; text encoder and
                                         ///< tokenizer are trained once, with the first seed
  std::map<std::string, int64_t> steps;  ///< of a stage, where not those of the preset
  std::map<std::string, int64_t> batch;
  int prompts = 150;
  std::string split = "test";
  uint64_t prompt_seed = 1;
  /// Sampling of the first variant's first model with one setting changed.
  std::vector<double> guidance_sweep;
  std::vector<int> steps_sweep;
};

/// One trained model of the comparison.
struct AblationModel {
  std::string variant;
  uint64_t seed = 0;
  training::TrainingRecipe recipe;
  std::map<std::string, std::string> files;  ///< stage -> file; equal stages share one
};

/// A model sampled and measured in one way.
struct AblationTrial {
  size_t model = 0;
  std::string sweep;  ///< "", "guidance" or "steps"
  SamplingOptions sampling;
  std::string file;  ///< of the result
};

/// One piece of work; the existence of its file says whether it is done.
struct AblationJob {
  std::string kind;  ///< a stage, or "trial"
  size_t item = 0;   ///< number of the model or trial
  std::string file;
  std::string title;          ///< "masked of no-ssta, seed 2"
  double gigaoperations = 0;  ///< rough: from the number of weights
};

struct AblationPlan {
  std::vector<AblationModel> models;
  std::vector<AblationTrial> trials;
  std::vector<AblationJob> jobs;  ///< in the order of work
};

/// What the results of a plan depend on besides its options.
struct AblationData {
  std::string
      training;      ///< identity of the clips of training and validation, and of the text encoder
  std::string exam;  ///< of the clips that are asked about, and of the judge
};

/// Makes the plan for the options. Files are named by a hash of everything that their content
/// depends on, so that a folder never mixes results, equal stages of several variants are trained
/// once, and a run with more variants or seeds reuses what is there. Throws Error for unknown
/// variants, stages or presets and for empty or repeated lists.
AblationPlan plan_ablation(const AblationOptions& options, const AblationData& data);

nlohmann::json sampling_description(const SamplingOptions& sampling);

}  // namespace remomask::lab
