#include <fmt/format.h>

#include "base/error.h"
#include "evaluation/generation_labels.h"
#include "evaluation/motion_embedding.h"
#include "generator/pipeline.h"
#include "generator/tokenizer_metrics.h"
#include "retriever/retrieval_metrics.h"
#include "tools/generation_options.h"
#include "tools/program.h"
#include "tools/workspace.h"

namespace remomask {

namespace {

std::vector<TrainingClip> evaluation_clips(const std::string& database_path,
                                           const std::string& split,
                                           const std::vector<std::string>& sources) {
  const Database database(database_path, OpenMode::read_only);
  TrainingSetOptions options;
  options.splits = {split};
  options.add_mirrored = false;
  options.sources = sources;
  auto clips = load_training_set(database, options);
  if (clips.empty()) {
    throw FileError(database_path, 0,
                    "has no clips of split \"" + split +
                        "\"; choose another "
                        "--split or import clips");
  }
  return clips;
}

void print_recall(const std::string& name, const char* direction, const RecallFigures& figures) {
  fmt::print(
      "{:<6} {:<15} R@1 {:5.1f}  R@2 {:5.1f}  R@3 {:5.1f}  R@5 {:5.1f}  R@10 {:5.1f}  "
      "MedR {:g}  ({} queries, gallery {})\n",
      name, direction, figures.recall[0], figures.recall[1], figures.recall[2], figures.recall[3],
      figures.recall[4], figures.median_rank, figures.queries, figures.gallery);
}

void print_labels(const std::string& name, const char* direction, const LabelFigures& figures) {
  if (figures.queries == 0) return;
  fmt::print(
      "{:<6} {:<15} first hit: same content {:5.1f}  same content and style {:5.1f}  by labels "
      "alone R@1 {:5.1f}  R@3 {:5.1f}  R@10 {:5.1f}  ({} queries with labels)\n",
      name, direction, figures.content, figures.meaning, figures.perfect_recall[0],
      figures.perfect_recall[2], figures.perfect_recall[4], figures.queries);
}

void register_evaluate_retrieval(CLI::App& parent, Program& program) {
  struct Options {
    FileOptions files;
    std::string split = "test";
    std::vector<std::string> sources;
    bool all_captions = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_command(parent, "retrieval", "recall and median rank of search by text and by motion",
                  "remomask evaluate retrieval --db motions.sqlite");
  options->files.add_model(*command);
  options->files.add_database(*command);
  command->add_option("--split", options->split, "clips to search among")->capture_default_str();
  command->add_option("--source", options->sources, "only these data sets (repeatable)");
  command->add_flag("--all-captions", options->all_captions, "every caption, not the first alone");
  command->callback([options, &program] {
    const std::string model_path = options->files.model_path();
    const Retriever retriever(load_stage(model_path, "retriever"));
    const auto clips =
        evaluation_clips(options->files.database_path(), options->split, options->sources);
    const RetrievalEvaluation result =
        evaluate_retrieval(retriever, clips, options->all_captions, program.monitor());
    program.finish_progress();
    if (program.json) {
      nlohmann::json document = result;
      document["split"] = options->split;
      document["model"] = model_path;
      return program.print_json(document);
    }
    fmt::print("split {}; {}\n", options->split, result.protocol);
    for (const RetrievalSubset& subset : result.subsets) {
      print_recall(subset.name, "text-to-motion", subset.text_to_motion);
      print_recall(subset.name, "motion-to-text", subset.motion_to_text);
    }
    for (const RetrievalSubset& subset : result.subsets) {
      print_labels(subset.name, "text-to-motion", subset.text_to_motion_labels);
      print_labels(subset.name, "motion-to-text", subset.motion_to_text_labels);
    }
  });
}

void print_reconstruction(const char* name, const ReconstructionErrors& errors) {
  fmt::print(
      "{:<11} MPJPE {:6.1f} mm   in the world {:6.1f} mm   bone length {:5.1f} mm   foot "
      "skate {:5.2f} mm/frame\n",
      name, errors.mpjpe, errors.global_mpjpe, errors.bone_length, errors.foot_skate);
}

void register_evaluate_tokenizer(CLI::App& parent, Program& program) {
  struct Options {
    FileOptions files;
    std::string split = "test";
    std::vector<std::string> sources;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_command(parent, "tokenizer", "reconstruction error of the tokenizer, use of its codes",
                  "remomask evaluate tokenizer --db motions.sqlite");
  options->files.add_model(*command);
  options->files.add_database(*command);
  command->add_option("--split", options->split, "clips to measure")->capture_default_str();
  command->add_option("--source", options->sources, "only these data sets (repeatable)");
  command->callback([options, &program] {
    const std::string model_path = options->files.model_path();
    TokenizerNetwork network = load_tokenizer_network(load_stage(model_path, "tokenizer"));
    const auto clips =
        evaluation_clips(options->files.database_path(), options->split, options->sources);
    const TokenizerMetrics metrics = measure_tokenizer(network, clip_features(clips));
    if (program.json) {
      nlohmann::json document = metrics;
      document["split"] = options->split;
      document["model"] = model_path;
      return program.print_json(document);
    }
    fmt::print("split {}: {} clips, {} frames; MPJPE: root of every frame subtracted\n",
               options->split, metrics.clips, metrics.frames);
    print_reconstruction("all levels", metrics.all_levels);
    print_reconstruction("base level", metrics.base_level);
    for (size_t level = 0; level < metrics.code_use.size(); ++level) {
      fmt::print("level {}     {:5.1f} % of the codes used, perplexity {:.0f}\n", level,
                 100 * metrics.code_use[level], metrics.perplexity[level]);
    }
  });
}

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
  command->add_option("--results", options->labels.results_path,
                      "JSON Lines, one outcome a prompt; an existing file is continued");
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

}  // namespace

void register_evaluate(CLI::App& app, Program& program) {
  CLI::App* command = add_command(app, "evaluate", "measure a model on a split of a database",
                                  "remomask evaluate retrieval --db motions.sqlite");
  command->require_subcommand(1);
  register_evaluate_retrieval(*command, program);
  register_evaluate_tokenizer(*command, program);
  register_evaluate_generation(*command, program);
}

}  // namespace remomask
