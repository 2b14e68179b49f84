#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/time.h"
#include "db/database.h"
#include "evaluation/evaluator.h"
#include "evaluation/generation_report.h"
#include "index/vector_index.h"
#include "nn/model_file.h"
#include "pipeline/motion_embedding.h"
#include "tools/evaluate_command.h"
#include "tools/generation_run.h"
#include "tools/index_path.h"

namespace remomask::tools {

namespace {

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

}  // namespace

void run_evaluate_generation(const EvaluateGenerationCommand& options, Program& program) {
  const std::string model_path = options.files.model_path();
  const evaluation::Evaluator evaluator =
      evaluation::load_evaluator(options.evaluator.evaluator_path());
  const TextToMotion remomask = open_model(options.files, program);
  const db::Database database(options.files.database_path(), db::OpenMode::read_only);
  const retriever::Retriever retriever = retriever::open_retriever(model_path);
  const auto index =
      index::VectorIndex::open(index_path(options.files), database, retriever.hash());
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
    if (prompt.frames > 0)
      one.seconds = std::min(seconds_of(static_cast<size_t>(prompt.frames)), kMaxClipSeconds);
    // Evidence comes from training clips alone, never from the prompt's own motion.
    one.evidence.splits = {"train"};
    one.evidence.excluded_groups = {prompt.group};
    return remomask.generate(prompt.text, one).motion;
  };
  evaluation::GenerationRunOptions run_options;
  run_options.prompts = options.prompts;
  run_options.seed = options.prompt_seed;
  run_options.prompt_split = options.prompt_split;
  run_options.draw = options.draw;
  run_options.repeats = options.repeats;
  run_options.modality_prompts = options.modality_prompts;
  run_options.results_path = options.results;
  run_options.generator = remomask.identity(chosen);
  const evaluation::JudgeGallery gallery(database, *judge, run_options.gallery_splits);
  const evaluation::GenerationRun run = evaluation::run_generation(
      database, gallery, *judge, evaluator, generate, run_options, program.monitor());
  const evaluation::GenerationReport report =
      evaluation::report_generation(run, database, gallery, evaluator);
  program.finish_progress();
  if (program.json) return program.print_json(report);
  print_report(report);
}

}  // namespace remomask::tools
