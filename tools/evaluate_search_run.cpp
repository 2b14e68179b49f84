#include <fmt/format.h>

#include <filesystem>

#include "base/counted.h"
#include "db/database.h"
#include "evaluation/prompt_search.h"
#include "evaluation/reliability_diagram.h"
#include "nn/model_file.h"
#include "remomask/error.h"
#include "search/word_model.h"
#include "tools/evaluate_input.h"
#include "tools/generation_run.h"

namespace remomask::tools {

namespace {

// What a first fit starts from, when the text file has no score yet.
constexpr search::WordScore kFirstScore{-9, 8, 4, 1.5, -6, 0, 1, -8, 8};
constexpr int kFits = 3;  // a better score finds other hits

void print_figures(const evaluation::PromptReport& report) {
  const bool intervals = !report.figures.front().intervals.empty();
  fmt::print("{:<10} {:>22} {:>22} {:>22} {:>8}\n", "search by", "hit@1", "hit@5", "hit@10", "MRR");
  for (const evaluation::PromptFigures& figures : report.figures) {
    const auto cell = [&](double value, size_t place) {
      if (!intervals) return fmt::format("{:.1f} %", 100 * value);
      return fmt::format("{:.1f} % ({:.1f}-{:.1f})", 100 * value,
                         100 * figures.intervals[place].low, 100 * figures.intervals[place].high);
    };
    fmt::print("{:<10} {:>22} {:>22} {:>22} {:>8.3f}\n", figures.by, cell(figures.hit_1, 0),
               cell(figures.hit_5, 1), cell(figures.hit_10, 2), figures.mean_reciprocal_rank);
  }
}

void print_calibration(const evaluation::PromptReport& report) {
  fmt::print("expected calibration error {:.3f} over {}; above 0.8: {}, {:.1f} % of them right\n",
             report.calibration_error, counted(static_cast<int64_t>(report.pairs.size()), "hit"),
             report.confident, 100 * report.confident_right);
  for (const search::ReliabilityBin& bin : report.bins) {
    if (bin.count == 0) continue;
    fmt::print("  predicted {:3.0f} to {:3.0f} %: {:5.1f} %, right {:5.1f} %  ({} hits)\n",
               100 * bin.low, 100 * bin.high, 100 * bin.predicted, 100 * bin.right, bin.count);
  }
  if (report.unanswerable > 0) {
    fmt::print("of {} that nothing answers, {:.1f} % are refused (no hit above 0.5)\n",
               counted(report.unanswerable, "prompt"), 100 * report.refused);
  }
}

void plot_reliability(const EvaluateSearchCommand& command,
                      const evaluation::PromptReport& report) {
  evaluation::write_reliability_diagram(
      command.plot, {.heading = "Search by sentence: " +
                                std::filesystem::path(command.prompts).filename().string(),
                     .scored = "probability",
                     .note = fmt::format("{}; expected calibration error {:.3f}",
                                         counted(static_cast<int64_t>(report.pairs.size()), "hit"),
                                         report.calibration_error),
                     .calibration = search::fit_calibration(report.probabilities, report.right),
                     .bins = report.bins,
                     .similarities = report.probabilities});
}

nlohmann::json report_json(const EvaluateSearchCommand& command,
                           const evaluation::PromptReport& report) {
  nlohmann::json bins = nlohmann::json::array();
  for (const search::ReliabilityBin& bin : report.bins) {
    bins.push_back({{"low", bin.low},
                    {"high", bin.high},
                    {"predicted", bin.predicted},
                    {"right", bin.right},
                    {"hits", bin.count}});
  }
  return {{"prompts", command.prompts},
          {"figures", report.figures},
          {"expected_calibration_error", report.calibration_error},
          {"bins", bins},
          {"confident", report.confident},
          {"confident_right", report.confident_right},
          {"unanswerable", report.unanswerable},
          {"refused", report.refused},
          {"missed", report.missed}};
}

}  // namespace

void run_evaluate_search(const EvaluateSearchCommand& command, Program& program) {
  const auto prompts = evaluation::read_search_prompts(command.prompts);
  const std::string model_path = command.files.model_path();
  const std::string text_path = text_file(command.files);
  search::WordModel words = search::WordModel::open(
      text_path, command.fit ? search::DamagedScore::is_none : search::DamagedScore::is_refused);
  const auto retriever = std::make_shared<const retriever::Retriever>(
      retriever::open_retriever(model_path, words.encoder));
  if (!words.score) {
    if (!command.fit) {
      throw FileError(text_path, 0, "holds no search score; fit one on other prompts with --fit");
    }
    words.score = kFirstScore;
  }
  std::map<int64_t, nlohmann::json> labels;
  {
    const db::Database database(command.files.database_path(), db::OpenMode::read_only);
    for (db::Clip& clip : database.clips()) labels[clip.id] = std::move(clip.labels);
  }
  evaluation::PromptSearchOptions options;
  options.filter = command.filter.filter();
  const auto measure = [&] {
    const search::MotionSearch motion_search(retriever,
                                             std::make_shared<const search::WordModel>(words),
                                             command.files.database_path(), command.files.index);
    return evaluation::measure_prompt_search(motion_search, prompts, labels, options,
                                             program.monitor());
  };
  options.bootstrap.resamples = 0;
  options.each_part = false;
  if (command.fit) {
    for (int round = 0; round < kFits; ++round) {
      const evaluation::PromptReport report = measure();
      words.score = search::fit_word_score(report.pairs, report.motion_pairs);
    }
  }
  options.each_part = true;
  options.bootstrap.resamples =
      command.resamples.value_or(evaluation::BootstrapOptions().resamples);
  const evaluation::PromptReport report = measure();
  program.finish_progress();
  if (command.fit) search::store_word_score(text_path, *words.score);
  if (!command.plot.empty()) plot_reliability(command, report);
  if (program.json) return program.print_json(report_json(command, report));
  fmt::print("{} of {}, {} clips\n", counted(static_cast<int64_t>(prompts.size()), "prompt"),
             command.prompts, labels.size());
  print_figures(report);
  print_calibration(report);
  for (const std::string& prompt : report.missed) fmt::print("  missed: {}\n", prompt);
  if (command.fit) {
    fmt::print("score stored in {}: {}\n", text_path, nlohmann::json(*words.score).dump());
  }
}

}  // namespace remomask::tools
