#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/evaluate_command.h"
#include "tools/program.h"

namespace remomask::tools {

/// What `remomask ablate` is asked for. What is empty or unset keeps the default of the ablation.
struct AblateCommand {
  std::string database, folder, docs;
  EvaluatorOption evaluator;
  std::vector<std::string> variants, sources, steps, batch;
  std::vector<uint64_t> seeds;
  std::optional<std::string> preset, split;
  std::optional<int> prompts;
  std::vector<double> guidance_sweep;
  std::vector<int> steps_sweep;
  bool dry_run = false;
};

void run_ablate(const AblateCommand& command, Program& program);

}  // namespace remomask::tools
