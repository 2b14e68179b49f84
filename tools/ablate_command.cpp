#include "tools/ablate_command.h"

#include <CLI/CLI.hpp>

#include "tools/core.h"
#include "tools/usage.h"

namespace remomask::tools {

void register_ablate(CLI::App& app, Program& program) {
  auto options = std::make_shared<AblateCommand>();
  CLI::App* command = add_command(
      app, "ablate", "train and measure variants of the model with equal budgets; resumes",
      "remomask ablate --db motions.sqlite --preset small --seeds 1,2,3 -o ablation");
  command->add_option("--db", options->database, "database with splits train, val and test")
      ->required();
  command->add_option("-o,--output", options->folder, "folder of stages, trials and results")
      ->required();
  command->add_option("--preset", options->preset, "sizes of all networks")
      ->check(CLI::IsMember({"tiny", "small", "base", "paper"}));
  command
      ->add_option("--variants", options->variants,
                   "default: all of docs/training.md; also levels-N and quantizer-dropout-PERCENT")
      ->delimiter(',');
  command->add_option("--seeds", options->seeds, "of retriever and transformers")->delimiter(',');
  add_repeatable(*command, "--steps", options->steps,
                 "NUMBER or STAGE=NUMBER ; default: of the preset");
  add_repeatable(*command, "--batch", options->batch, "clips a step, NUMBER or STAGE=NUMBER");
  command->add_option("--source", options->sources, "only these data sets (repeatable)");
  options->evaluator.add(*command);
  command->add_option("--prompts", options->prompts, "motions a trial")->check(at_least(1));
  command->add_option("--split", options->split, "captions of these clips")->capture_default_str();
  command
      ->add_option("--guidance-sweep", options->guidance_sweep,
                   "guidance of further trials of the first variant")
      ->delimiter(',');
  command
      ->add_option("--steps-sweep", options->steps_sweep,
                   "passes of further trials of the first variant")
      ->delimiter(',')
      ->check(number_between(1, 1000));
  command->add_option("--write-docs", options->docs,
                      "folder whose results.md gets tables and pictures");
  command->add_flag("--dry-run", options->dry_run, "print the plan with its estimated cost");
  command->callback([options, &program] { core(program).ablate(*options, program); });
}

}  // namespace remomask::tools
