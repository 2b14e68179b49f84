#include "tools/evaluate_command.h"

#include "db/database.h"
#include "evaluation/retrieval_metrics.h"
#include "remomask/error.h"
#include "remomask/library.h"

namespace remomask::tools {

void EvaluationInput::add(CLI::App& command) {
  files.add_model(command);
  add_clips(command);
}

void EvaluationInput::add_clips(CLI::App& command) {
  files.add_database(command);
  command.add_option("--split", split, "clips to measure")->capture_default_str();
  command.add_option("--source", sources, "only these data sets (repeatable)");
}

std::vector<db::TrainingClip> EvaluationInput::load(const std::string& wanted_split,
                                                    motion::FeatureMode mode) const {
  const std::string path = files.database_path();
  const db::Database database(path, db::OpenMode::read_only);
  db::TrainingSetOptions options;
  options.splits = {wanted_split};
  options.add_mirrored = false;
  options.sources = sources;
  options.mode = mode;
  auto clips = db::load_training_set(database, options);
  if (clips.empty()) {
    throw FileError(
        path, 0,
        "has no clips of split \"" + wanted_split + "\"; choose another --split or import clips");
  }
  return clips;
}

nlohmann::json EvaluationInput::stamped(nlohmann::json document,
                                        const std::vector<db::TrainingClip>& clips) const {
  document["model"] = files.model_path();
  document["split"] = split;
  document["split_hash"] = evaluation::clip_set_hash(clips);
  return document;
}

void EvaluatorOption::add(CLI::App& command) {
  command.add_option("--evaluator", path,
                     "text-motion evaluator (.safetensors); default: the shipped one");
}

std::string EvaluatorOption::evaluator_path() const {
  return path.empty() ? shipped_file("evaluator.safetensors") : path;
}

void register_evaluate(CLI::App& app, Program& program) {
  CLI::App* command = add_command(app, "evaluate", "measure a model on a split of a database",
                                  "remomask evaluate retrieval --db motions.sqlite");
  command->require_subcommand(1);
  register_evaluate_retrieval(*command, program);
  register_evaluate_calibration(*command, program);
  register_evaluate_moments(*command, program);
  register_evaluate_queries(*command, program);
  register_evaluate_evaluator(*command, program);
  register_evaluate_tokenizer(*command, program);
  register_evaluate_generation(*command, program);
}

}  // namespace remomask::tools
