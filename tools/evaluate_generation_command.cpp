#include <fmt/format.h>

#include "evaluation/generation_labels.h"
#include "evaluation/motion_embedding.h"
#include "generator/pipeline.h"
#include "tools/evaluate_command.h"
#include "tools/generation_options.h"
#include "tools/workspace.h"

namespace remomask {

void register_evaluate_generation(CLI::App& parent, Program& program) {
  struct Options {
    FileOptions files;
    GenerationOptions generation;
    GenerationLabelOptions labels;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = add_command(
      parent, "generation",
      "do generated motions show what their prompt asks for? (nearest real motion)",
      "remomask evaluate generation --db motions.sqlite --prompts 200 --results outcomes.jsonl");
  options->files.add_model(*command);
  options->files.add_database(*command);
  options->generation.add(*command);
  command->add_option("--prompts", options->labels.prompts, "number of prompts")
      ->capture_default_str();
  command->add_option("--split", options->labels.prompt_split, "captions of these clips")
      ->capture_default_str();
  command->add_option("--prompt-seed", options->labels.seed, "choice of the prompts")
      ->capture_default_str();
  command
      ->add_option("--results", options->labels.results_path,
                   "JSON Lines, one outcome a prompt; an existing file is continued")
      ->required();
  command->callback([options, &program] {
    const std::string model_path = options->files.model_path();
    const auto stages = load_model(model_path);
    const GenerationWorkspace workspace(stages, model_path, options->files, options->generation);
    GenerationLabelOptions labels = options->labels;
    labels.generator = workspace.identity();
    const auto generate = [&](const LabelPrompt& prompt) {
      // Evidence comes from training clips alone, never from the prompt's own motion.
      ClipFilter evidence;
      evidence.splits = {"train"};
      evidence.excluded_groups = {prompt.group};
      return workspace.generate(prompt.text, prompt.seed, evidence, prompt.frames).generated.motion;
    };
    const auto embed = [&](const Motion& motion) {
      return embed_motion(workspace.search().retriever(), motion);
    };
    const GenerationLabelReport report =
        measure_generation_labels(workspace.search().database(), workspace.search().index(),
                                  generate, embed, labels, program.monitor());
    program.finish_progress();
    if (program.json) return program.print_json(report);
    fmt::print("{} of {} prompts right: {:.1f} % (standard error {:.1f}; chance {:.1f} %)\n",
               report.right, report.prompts, 100 * report.accuracy, 100 * report.standard_error,
               100 * report.chance);
    for (const auto& [content, count] : report.labels) {
      fmt::print("  {:<28} {:3} of {:3}\n", content, count.right, count.prompts);
    }
    const PhysicalMetrics& body = report.physical.values;
    fmt::print(
        "bones: mean error {:.2f} %, worst {:.2f} %; below the floor: worst {:.1f} cm; foot "
        "skate {:.3f} m/s; {} motions not finite\n",
        100 * body.bone_length_mean, 100 * body.bone_length_max, 100 * body.penetration_max,
        body.foot_skate, report.physical.not_finite);
  });
}

}  // namespace remomask
