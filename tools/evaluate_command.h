#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "db/training_set.h"
#include "evaluation/evaluator.h"
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
  /// Clips of `wanted_split` of the sources, without mirror twins that are not
  /// stored. Throws FileError when there are none.
  std::vector<db::TrainingClip> load(const std::string& wanted_split,
                                     motion::FeatureMode mode) const;
  std::vector<db::TrainingClip> load(motion::FeatureMode mode) const { return load(split, mode); }
  /// The document of --json with what was measured: model, split, hash of its clips.
  nlohmann::json stamped(nlohmann::json document, const std::vector<db::TrainingClip>& clips) const;
};

/// --evaluator: the text-motion evaluator, by default the shipped one.
struct EvaluatorOption {
  std::string path;

  void add(CLI::App& command);
  std::string evaluator_path() const;
  evaluation::Evaluator load() const { return evaluation::load_evaluator(evaluator_path()); }
};

/// The sub-commands of `remomask evaluate`.
void register_evaluate_retrieval(CLI::App& parent, Program& program);
void register_evaluate_calibration(CLI::App& parent, Program& program);
void register_evaluate_moments(CLI::App& parent, Program& program);
void register_evaluate_queries(CLI::App& parent, Program& program);
void register_evaluate_evaluator(CLI::App& parent, Program& program);
void register_evaluate_tokenizer(CLI::App& parent, Program& program);
void register_evaluate_generation(CLI::App& parent, Program& program);

}  // namespace remomask::tools
