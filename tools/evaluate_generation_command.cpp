#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "db/database.h"
#include "evaluation/generation_report.h"
#include "index/vector_index.h"
#include "nn/model_file.h"
#include "pipeline/motion_embedding.h"
#include "remomask/text_to_motion.h"
#include "tools/evaluate_command.h"
#include "tools/generation_options.h"
#include "tools/workspace.h"

namespace remomask::tools {

namespace {

constexpr double kMaxEvaluatedSeconds = 9.8;  // what the transformers see at once

struct EvaluateGenerationOptions {
  FileOptions files;
  EvaluatorOption evaluator;
  GenerationOptions generation;
  evaluation::GenerationRunOptions run;
  evaluation::GenerationReportOptions report;
  std::string judge = "evaluator";
};

std::string figure_text(const evaluation::Figure& figure) {
  return std::isnan(figure.mean) ? "-"
                                 : fmt::format("{:.3f} +-{:.3f}", figure.mean, figure.interval);
}

void print_row(const evaluation::GenerationSubset& subset, const char* name,
               const evaluation::MotionFigures& figures) {
  const auto& top = figures.captions.r_precision;
  const auto& by_labels = figures.labels.r_precision;
  fmt::print("{:<6}{:<10}{:>7.1f}  {:>14}  {:>14}  {:>14}  {:>14}  {:>16}  {:>16}  {:>15}\n",
             subset.name, name, 100 * figures.content.accuracy, figure_text(top[0]),
             figure_text(top[1]), figure_text(top[2]), figure_text(by_labels[2]),
             figure_text(figures.captions.fid), figure_text(figures.captions.mm_dist),
             figure_text(figures.captions.diversity));
}

void print_body(const evaluation::GenerationSubset& subset, const char* name,
                const evaluation::MotionFigures& figures) {
  const PhysicalMetrics& body = figures.physical.values;
  const auto side = [](const evaluation::SideCount& count) {
    return count.asked == 0 ? std::string("-") : fmt::format("{} of {}", count.right, count.asked);
  };
  fmt::print(
      "{:<6}{:<10}{:>11}  {:>11}  {:>10.3f}  {:>9.2f}  {:>9.1f}  {:>8.2f}  {:>8.1f}  {:>7}\n",
      subset.name, name, side(figures.sides.hands), side(figures.sides.turns), body.foot_skate,
      100 * body.bone_length_mean, 100 * body.penetration_max, 100 * body.floating_share, body.jerk,
      figures.physical.not_finite);
}

void print_report(const evaluation::GenerationReport& report) {
  const nlohmann::json& protocol = report.protocol;
  fmt::print(
      "protocol {}: {} prompts of {}, drawn {}, {} generations each, {} draws of batches of {}; "
      "chance {:.1f} %\njudge {}, {} gallery clips; evaluator {}\n\n",
      protocol.at("protocol").get<std::string>(), report.subsets.front().prompts,
      protocol.at("prompt_split").get<std::string>(), protocol.at("draw").get<std::string>(),
      protocol.at("repeats").get<int>(), protocol.at("draws").get<int>(),
      protocol.at("batch").get<int>(), 100 * report.subsets.front().chance,
      protocol.at("judge").get<std::string>(), protocol.at("gallery_clips").get<int>(),
      protocol.at("evaluator").get<std::string>());
  fmt::print("{:<16}{:>7}  {:>14}  {:>14}  {:>14}  {:>14}  {:>16}  {:>16}  {:>15}\n", "prompts",
             "content", "R@1", "R@2", "R@3", "R@3, labels", "FID", "MM-Dist", "Diversity");
  for (const evaluation::GenerationSubset& subset : report.subsets) {
    print_row(subset, "generated", subset.generated);
    print_row(subset, "real", subset.real);
  }
  fmt::print("MultiModality {}\n\n", figure_text(report.multimodality));
  fmt::print("{:<16}{:>11}  {:>11}  {:>10}  {:>9}  {:>9}  {:>8}  {:>8}  {:>7}\n", "prompts", "hand",
             "turn", "skate m/s", "bones %", "deepest cm", "float %", "jerk", "broken");
  for (const evaluation::GenerationSubset& subset : report.subsets) {
    print_body(subset, "generated", subset.generated);
    print_body(subset, "real", subset.real);
  }
  const double skate = report.subsets.front().generated.physical.values.foot_skate,
               real_skate = report.subsets.front().real.physical.values.foot_skate;
  if (real_skate > 0)
    fmt::print("foot skate {:.2f} times that of the real clips\n", skate / real_skate);
  fmt::print("\n");
  for (const auto& [content, count] : report.contents) {
    fmt::print("  {:<28} {:3} of {:3}\n", content, count.right, count.motions);
  }
}

void evaluate_generation(const EvaluateGenerationOptions& options, Program& program) {
  const std::string model_path = options.files.model_path();
  const evaluation::Evaluator evaluator = options.evaluator.load();
  OpenOptions open;
  open.index = options.files.index;
  open.threads = program.threads;
  const TextToMotion remomask(model_path, options.files.database_path(), open);
  const db::Database database(options.files.database_path(), db::OpenMode::read_only);
  const retriever::Retriever retriever(nn::load_stage(model_path, "retriever"));
  const auto index =
      index::VectorIndex::open(options.files.index_path(), database, retriever.hash());
  index.require_current(database);
  const auto judge = options.judge == "evaluator"
                         ? evaluation::evaluator_judge(evaluator, database)
                         : evaluation::retriever_judge(index, [&](const Motion& motion) {
                             return pipeline::embed_motion(retriever, motion);
                           });
  const GenerateOptions chosen = options.generation.chosen();
  const auto generate = [&](const evaluation::LabelPrompt& prompt) {
    GenerateOptions one = chosen;
    one.seed = prompt.seed;
    if (prompt.frames > 0) one.seconds = std::min(prompt.frames / 20.0, kMaxEvaluatedSeconds);
    // Evidence comes from training clips alone, never from the prompt's own motion.
    one.evidence.splits = {"train"};
    one.evidence.excluded_groups = {prompt.group};
    return remomask.generate(prompt.text, one).motion;
  };
  evaluation::GenerationRunOptions run_options = options.run;
  run_options.generator = remomask.identity(chosen);
  const evaluation::JudgeGallery gallery(database, *judge, run_options.gallery_splits);
  const evaluation::GenerationRun run = evaluation::run_generation(
      database, gallery, *judge, evaluator, generate, run_options, program.monitor());
  const evaluation::GenerationReport report =
      evaluation::report_generation(run, database, gallery, evaluator, options.report);
  program.finish_progress();
  if (program.json) return program.print_json(report);
  print_report(report);
}

}  // namespace

void register_evaluate_generation(CLI::App& parent, Program& program) {
  auto options = std::make_shared<EvaluateGenerationOptions>();
  CLI::App* command = add_command(
      parent, "generation",
      "generated motions beside real ones: FID, R-precision, content, sides, physics",
      "remomask evaluate generation --db motions.sqlite --prompts 200 --results outcomes.jsonl");
  options->files.add_model(*command);
  options->files.add_database(*command);
  options->evaluator.add(*command);
  options->generation.add(*command);
  evaluation::GenerationRunOptions& run = options->run;
  command
      ->add_option("--prompts", run.prompts, "number of prompts; 0: every clip of the split once")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_option("--split", run.prompt_split, "captions of these clips")
      ->capture_default_str();
  command
      ->add_option("--draw", run.draw,
                   "even: prompts spread over the contents; uniform: every clip equally likely")
      ->capture_default_str()
      ->check(CLI::IsMember({"even", "uniform"}));
  command->add_option("--prompt-seed", run.seed, "choice of the prompts")->capture_default_str();
  command->add_option("--repeats", run.repeats, "generations of every prompt (papers: 20)")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--modality-prompts", run.modality_prompts,
                   "prompts with 30 more generations, for MultiModality (papers: 96)")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_option("--judge", options->judge, "space in which the nearest real motion is found")
      ->capture_default_str()
      ->check(CLI::IsMember({"evaluator", "retriever"}));
  command
      ->add_option("--results", run.results_path,
                   "JSON Lines, one motion a line; an existing file is continued")
      ->required();
  command->callback([options, &program] { evaluate_generation(*options, program); });
}

}  // namespace remomask::tools
