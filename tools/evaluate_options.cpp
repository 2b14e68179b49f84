#include "remomask/library.h"
#include "tools/evaluate_command.h"

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

void EvaluatorOption::add(CLI::App& command) {
  command.add_option("--evaluator", path,
                     "text-motion evaluator (.safetensors); default: the shipped one");
}

std::string EvaluatorOption::evaluator_path() const {
  return path.empty() ? shipped_file("evaluator.safetensors") : path;
}

}  // namespace remomask::tools
