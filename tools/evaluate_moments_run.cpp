#include <fmt/format.h>

#include "base/counted.h"
#include "evaluation/moment_metrics.h"
#include "evaluation/retrieval_metrics.h"
#include "nn/model_file.h"
#include "retriever/retriever.h"
#include "tools/evaluate_input.h"

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

void run_evaluate_moments(const EvaluateMomentsCommand& command, Program& program) {
  evaluation::MomentTaskOptions tasks;
  search::MomentOptions moments;
  evaluation::BootstrapOptions bootstrap;
  if (command.tasks) tasks.tasks = *command.tasks;
  if (command.seed) tasks.seed = *command.seed;
  if (!command.windows.empty()) moments.lengths = command.windows;
  if (command.stride) moments.stride = *command.stride;
  if (command.margin) moments.margin = *command.margin;
  if (command.share) moments.share = *command.share;
  if (command.resamples) bootstrap.resamples = *command.resamples;
  const std::string model_path = command.input.files.model_path();
  const retriever::Retriever retriever = retriever::open_retriever(model_path);
  const auto clips = load_clips(command.input, command.input.split, retriever.feature_mode());
  const evaluation::MomentEvaluation result =
      evaluation::measure_moments(retriever, clips, tasks, moments, bootstrap, program.monitor());
  program.finish_progress();
  if (program.json) return program.print_json(stamped(command.input, result, clips));
  fmt::print(
      "split {} ({}, {}): {} motions of {} clips with different contents, joined; "
      "sentence: "
      "first caption of one of them\n",
      command.input.split, counted(static_cast<int64_t>(clips.size()), "clip"),
      evaluation::clip_set_hash(clips), result.tasks.tasks, result.tasks.parts);
  if (result.bootstrap.resamples > 0) {
    fmt::print("in brackets: {:g} % intervals, bootstrap over motions, {} resamples, seed {}\n",
               100 * result.bootstrap.level, result.bootstrap.resamples, result.bootstrap.seed);
  }
  const int width = result.bootstrap.resamples > 0 ? 19 : 5;
  fmt::print("{:<28}  {:<{}}  {:<{}}  mean IoU\n", "", "R@1 IoU 0.5", width, "R@1 IoU 0.7", width);
  print_moments("in the joined motion", result.found);
  print_moments("in the clip alone", result.alone);
  print_moments("a random third of the frames", result.chance);
}

}  // namespace remomask::tools
