#include <fmt/format.h>

#include "base/counted.h"
#include "evaluation/query_robustness.h"
#include "nn/model_file.h"
#include "retriever/retriever.h"
#include "tools/evaluate_input.h"

namespace remomask::tools {

namespace {

void print_queries(const char* title, const std::vector<evaluation::QueryFigures>& all) {
  fmt::print("\n{:<22} {:>7}  {:<20} {:<20} {:>22}  {:>14}\n", title, "queries", "  R@1", "  R@10",
             "first hit right (labels)", "top 10 shared");
  const auto with_interval = [](const evaluation::RecallFigures& figures, size_t place) {
    std::string text = fmt::format("{:5.1f}", figures.recall[place]);
    if (figures.intervals.empty()) return text;
    return text + fmt::format(" ({:.1f}-{:.1f})", figures.intervals[place].low,
                              figures.intervals[place].high);
  };
  for (const evaluation::QueryFigures& figures : all) {
    fmt::print("{:<22} {:>7}  {:<20} {:<20} {:>22.1f}  {:>14.1f}\n", figures.name,
               figures.recall.queries, with_interval(figures.recall, 0),
               with_interval(figures.recall, evaluation::kRecallRanks.size() - 1),
               figures.same_meaning, figures.overlap);
  }
}

}  // namespace

void run_evaluate_queries(const EvaluateQueriesCommand& command, Program& program) {
  evaluation::BootstrapOptions bootstrap;
  if (command.resamples) bootstrap.resamples = *command.resamples;
  const std::string model_path = command.input.files.model_path();
  const retriever::Retriever retriever = retriever::open_retriever(model_path);
  const auto clips = load_clips(command.input, command.input.split, retriever.feature_mode());
  const evaluation::QueryRobustness result =
      evaluation::measure_query_robustness(retriever, clips, bootstrap, program.monitor());
  program.finish_progress();
  if (program.json) return program.print_json(stamped(command.input, result, clips));
  fmt::print("text-to-motion, split {} ({}, {}), full gallery; {}\n", command.input.split,
             counted(static_cast<int64_t>(clips.size()), "clip"), evaluation::clip_set_hash(clips),
             evaluation::retrieval_definition(evaluation::RetrievalProtocol::duplicates, {}));
  print_queries("form of all captions", result.forms);
  print_queries("paraphrases", result.paraphrases);
  print_queries("top 100 by part vectors", result.reranked);
}

}  // namespace remomask::tools
