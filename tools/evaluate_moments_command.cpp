#include <fmt/format.h>

#include "evaluation/moment_metrics.h"
#include "evaluation/retrieval_metrics.h"
#include "tools/evaluate_command.h"

namespace remomask::tools {

namespace {

void print_moments(const char* name, const evaluation::MomentFigures& figures) {
  fmt::print("{:<28}", name);
  const double values[] = {figures.recall_50, figures.recall_70, figures.mean_iou};
  for (size_t i = 0; i < 3; ++i) {
    fmt::print("  {:5.1f}", values[i]);
    if (figures.intervals.empty()) continue;
    fmt::print(" {:<13}",
               fmt::format("({:.1f}-{:.1f})", figures.intervals[i].low, figures.intervals[i].high));
  }
  fmt::print("\n");
}

}  // namespace

void register_evaluate_moments(CLI::App& parent, Program& program) {
  struct Options {
    EvaluationInput input;
    evaluation::MomentTaskOptions tasks;
    search::MomentOptions moments;
    evaluation::BootstrapOptions bootstrap;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = add_command(parent, "moments",
                                  "does search find where in a long motion its sentence happens?",
                                  "remomask evaluate moments --db motions.sqlite --tasks 300");
  options->input.add(*command);
  command->add_option("--tasks", options->tasks.tasks, "long motions, each of three clips joined")
      ->capture_default_str();
  command->add_option("--seed", options->tasks.seed, "choice of the clips")->capture_default_str();
  command
      ->add_option("--windows", options->moments.lengths,
                   "lengths of the windows, frames at 20 fps")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--stride", options->moments.stride, "frames between windows")
      ->capture_default_str();
  command
      ->add_option("--margin", options->moments.margin,
                   "least similarity by which the frames outside a moment fall short")
      ->capture_default_str();
  command
      ->add_option("--share", options->moments.share,
                   "of the way from the worst frame to the best, where a moment ends")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--resamples", options->bootstrap.resamples, "of the intervals; 0: none")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  command->callback([options, &program] {
    const std::string model_path = options->input.files.model_path();
    const retriever::Retriever retriever(nn::load_stage(model_path, "retriever"));
    const auto clips = options->input.load(retriever.feature_mode());
    const evaluation::MomentEvaluation result = evaluation::measure_moments(
        retriever, clips, options->tasks, options->moments, options->bootstrap, program.monitor());
    program.finish_progress();
    if (program.json) return program.print_json(options->input.stamped(result, clips));
    fmt::print(
        "split {} ({} clips, {}): {} motions of {} clips with different contents, joined; "
        "sentence: "
        "first caption of one of them\n",
        options->input.split, clips.size(), evaluation::clip_set_hash(clips), result.tasks.tasks,
        result.tasks.parts);
    if (result.bootstrap.resamples > 0) {
      fmt::print("in brackets: {:g} % intervals, bootstrap over motions, {} resamples, seed {}\n",
                 100 * result.bootstrap.level, result.bootstrap.resamples, result.bootstrap.seed);
    }
    const int width = result.bootstrap.resamples > 0 ? 19 : 5;
    fmt::print("{:<28}  {:<{}}  {:<{}}  mean IoU\n", "", "R@1 IoU 0.5", width, "R@1 IoU 0.7",
               width);
    print_moments("in the joined motion", result.found);
    print_moments("in the clip alone", result.alone);
    print_moments("a random third of the frames", result.chance);
  });
}

}  // namespace remomask::tools
