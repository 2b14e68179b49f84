#include <fmt/format.h>

#include "base/counted.h"
#include "evaluation/retrieval_metrics.h"
#include "nn/model_file.h"
#include "retriever/retriever.h"
#include "tools/evaluate_input.h"

namespace remomask::tools {

namespace {

std::string with_interval(double value, const std::vector<evaluation::Interval>& intervals,
                          size_t place, int width) {
  if (intervals.empty()) return fmt::format("{:{}.1f}", value, width);
  return fmt::format("{:{}.1f} {:<13}", value, width,
                     fmt::format("({:.1f}-{:.1f})", intervals[place].low, intervals[place].high));
}

void print_recall(const std::string& name, const char* direction,
                  const evaluation::RecallFigures& figures) {
  std::string line = fmt::format("{:<5} {:>5}  {:<14}", name, figures.queries, direction);
  for (size_t i = 0; i < evaluation::kRecallRanks.size(); ++i) {
    line += "  " + with_interval(figures.recall[i], figures.intervals, i, 5);
  }
  fmt::print(
      "{}  {}\n", line,
      with_interval(figures.median_rank, figures.intervals, evaluation::kRecallRanks.size(), 5));
}

void print_labels(const std::string& name, const char* direction,
                  const evaluation::LabelFigures& figures) {
  if (figures.queries == 0) return;
  fmt::print("{:<5} labels {:>5}  {:<14} {:9.1f} {:17.1f} {:9.1f} {:6.1f} {:6.1f}\n", name,
             figures.queries, direction, figures.content, figures.meaning,
             figures.perfect_recall[0], figures.perfect_recall[2], figures.perfect_recall[4]);
}

void print_protocol(const evaluation::ProtocolEvaluation& protocol,
                    const evaluation::RetrievalEvaluation& evaluation, const std::string& split) {
  if (protocol.subsets.empty()) return;
  const bool intervals = evaluation.bootstrap.resamples > 0;
  fmt::print("\nprotocol {}: {}\n  {} (gallery {}, {}, {})\n  captions: {}\n",
             evaluation::retrieval_protocol_name(protocol.protocol), protocol.definition, split,
             protocol.subsets.front().text_to_motion.recall.gallery,
             counted(static_cast<int64_t>(evaluation.clips), "clip"), evaluation.split_hash,
             evaluation.captions);
  if (intervals) {
    fmt::print("  in brackets: {:g} % intervals, bootstrap over queries, {} resamples, seed {}\n",
               100 * evaluation.bootstrap.level, evaluation.bootstrap.resamples,
               evaluation.bootstrap.seed);
  }
  fmt::print("{:<27}", "queries");
  for (const int rank : evaluation::kRecallRanks) {
    fmt::print("  {:<{}}", fmt::format("  R@{}", rank), intervals ? 19 : 5);
  }
  fmt::print("   MedR\n");
  for (const evaluation::RetrievalSubset& subset : protocol.subsets) {
    print_recall(subset.name, "text-to-motion", subset.text_to_motion.recall);
    print_recall(subset.name, "motion-to-text", subset.motion_to_text.recall);
  }
  if (protocol.subsets.front().text_to_motion.labels.queries == 0) return;
  fmt::print("{:<34} {:>10} {:>17}  {}\n", "first hit shows the same", "content",
             "content and style", "by labels alone: R@1, R@3, R@10");
  for (const evaluation::RetrievalSubset& subset : protocol.subsets) {
    print_labels(subset.name, "text-to-motion", subset.text_to_motion.labels);
    print_labels(subset.name, "motion-to-text", subset.motion_to_text.labels);
  }
}

}  // namespace

void run_evaluate_retrieval(const EvaluateRetrievalCommand& command, Program& program) {
  evaluation::RetrievalOptions measure;
  if (command.threshold) measure.settings.threshold = *command.threshold;
  if (command.resamples) measure.bootstrap.resamples = *command.resamples;
  measure.all_captions = command.all_captions;
  if (!command.protocols.empty()) measure.protocols.clear();
  for (const std::string& name : command.protocols) {
    measure.protocols.push_back(evaluation::parse_retrieval_protocol(name));
  }
  const std::string model_path = command.input.files.model_path();
  const retriever::Retriever retriever = retriever::open_retriever(model_path);
  const auto clips = load_clips(command.input, command.input.split, retriever.feature_mode());
  const evaluation::RetrievalEvaluation result =
      evaluation::evaluate_retrieval(retriever, clips, measure, program.monitor());
  program.finish_progress();
  if (program.json) return program.print_json(stamped(command.input, result, clips));
  for (const evaluation::ProtocolEvaluation& protocol : result.protocols) {
    print_protocol(protocol, result, "split " + command.input.split);
  }
}

}  // namespace remomask::tools
