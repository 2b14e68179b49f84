#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "tools/generation_options.h"
#include "tools/program.h"
#include "tools/workspace.h"

namespace remomask::tools {

/// --model, --db, --split and --source: what is measured.
struct EvaluationInput {
  FileOptions files;
  std::string split = "test";
  std::vector<std::string> sources;

  void add(CLI::App& command);
  /// Without --model, for what needs no model.
  void add_clips(CLI::App& command);
};

/// --evaluator: the text-motion evaluator, by default the shipped one.
struct EvaluatorOption {
  std::string path;

  void add(CLI::App& command);
  std::string evaluator_path() const;
};

// What the sub-commands of `remomask evaluate` are asked for. What is not set keeps the default of
// the measurement.

struct EvaluateRetrievalCommand {
  EvaluationInput input;
  std::vector<std::string> protocols;
  std::optional<double> threshold;
  std::optional<int> resamples;
  bool all_captions = false;
};

struct EvaluateCalibrationCommand {
  EvaluateCalibrationCommand() { input.split = "val"; }

  EvaluationInput input;
  std::string check = "test", plot;
  bool store = false;
};

struct EvaluateMomentsCommand {
  EvaluationInput input;
  std::optional<int> tasks, stride, resamples;
  std::optional<uint64_t> seed;
  std::vector<int> windows;
  std::optional<double> margin, share;
};

struct EvaluateQueriesCommand {
  EvaluationInput input;
  std::optional<int> resamples;
};

struct EvaluateSearchCommand {
  FileOptions files;
  FilterOptions filter;
  std::string prompts, plot;
  bool fit = false;
  std::optional<int> resamples;
};

struct EvaluateEvaluatorCommand {
  EvaluationInput input;
  EvaluatorOption evaluator;
  std::optional<int> draws, batch;
};

struct EvaluateTokenizerCommand {
  EvaluationInput input;
  EvaluatorOption evaluator;
};

struct EvaluateGenerationCommand {
  FileOptions files;
  EvaluatorOption evaluator;
  GenerationOptions generation;
  int prompts = 200;
  std::string prompt_split = "test", draw = "even", judge = "evaluator", results;
  uint64_t prompt_seed = 1;
  int repeats = 1, modality_prompts = 10;
};

void run_evaluate_retrieval(const EvaluateRetrievalCommand& command, Program& program);
void run_evaluate_calibration(const EvaluateCalibrationCommand& command, Program& program);
void run_evaluate_moments(const EvaluateMomentsCommand& command, Program& program);
void run_evaluate_queries(const EvaluateQueriesCommand& command, Program& program);
void run_evaluate_search(const EvaluateSearchCommand& command, Program& program);
void run_evaluate_evaluator(const EvaluateEvaluatorCommand& command, Program& program);
void run_evaluate_tokenizer(const EvaluateTokenizerCommand& command, Program& program);
void run_evaluate_generation(const EvaluateGenerationCommand& command, Program& program);

}  // namespace remomask::tools
