#include <fmt/format.h>

#include <algorithm>

#include "db/database.h"
#include "evaluation/calibration_hits.h"
#include "evaluation/reliability_diagram.h"
#include "nn/model_file.h"
#include "retriever/retriever.h"
#include "tools/evaluate_input.h"

namespace remomask::tools {

namespace {

constexpr const char* kCalibrationRule =
    "all captions, their ten most similar clips of the whole split; right: the same group, the "
    "identical normalised caption, or the same labels content and style";

double share_right(const evaluation::JudgedHits& hits) {
  const auto right = std::count(hits.right.begin(), hits.right.end(), true);
  return static_cast<double>(right) / static_cast<double>(hits.right.size());
}

/// (1 + cosine) / 2 taken for a share: what there is without a calibration.
double uncalibrated_error(const evaluation::JudgedHits& hits) {
  std::vector<double> shares;
  for (const double similarity : hits.similarities) shares.push_back((1 + similarity) / 2);
  return search::expected_calibration_error(search::reliability_bins(shares, hits.right));
}

}  // namespace

void run_evaluate_calibration(const EvaluateCalibrationCommand& command, Program& program) {
  const EvaluationInput& input = command.input;
  const std::string model_path = input.files.model_path();
  const retriever::Retriever retriever = retriever::open_retriever(model_path);
  const auto hits_of = [&](const std::string& split) {
    const auto clips = load_clips(input, split, retriever.feature_mode());
    return evaluation::judge_hits(
        evaluation::encode_split(retriever, clips, true, program.monitor()), clips);
  };
  const evaluation::JudgedHits fitted = hits_of(input.split), checked = hits_of(command.check);
  program.finish_progress();
  const search::Calibration calibration =
      search::fit_calibration(fitted.similarities, fitted.right);
  const auto bins =
      search::reliability_bins(evaluation::predicted_shares(calibration, checked), checked.right);
  const double error = search::expected_calibration_error(bins);
  if (command.store) {
    db::Database database(input.files.database_path(), db::OpenMode::read_write);
    database.set_fact(search::calibration_fact(retriever.hash()),
                      nlohmann::json(calibration).dump());
  }
  if (!command.plot.empty()) {
    evaluation::write_reliability_diagram(
        command.plot, {.heading = fmt::format("Calibration of search: fitted on {}, checked on {}",
                                              input.split, command.check),
                       .note = fmt::format("{} and {} hits; expected calibration error {:.3f}",
                                           fitted.right.size(), checked.right.size(), error),
                       .calibration = calibration,
                       .bins = bins,
                       .similarities = checked.similarities});
  }
  if (program.json) {
    nlohmann::json reliability = nlohmann::json::array();
    for (const search::ReliabilityBin& bin : bins) {
      reliability.push_back({{"low", bin.low},
                             {"high", bin.high},
                             {"predicted", bin.predicted},
                             {"right", bin.right},
                             {"hits", bin.count}});
    }
    return program.print_json({{"model", model_path},
                               {"retriever", retriever.hash()},
                               {"rule", kCalibrationRule},
                               {"split", input.split},
                               {"check", command.check},
                               {"share_right", share_right(checked)},
                               {"expected_calibration_error", error},
                               {"uncalibrated_error", uncalibrated_error(checked)},
                               {"bins", reliability},
                               {"calibration", calibration}});
  }
  fmt::print("{}\nfitted on {}: {} hits, {:.1f} % right\nchecked on {}: {} hits, {:.1f} % right\n",
             kCalibrationRule, input.split, fitted.right.size(), 100 * share_right(fitted),
             command.check, checked.right.size(), 100 * share_right(checked));
  fmt::print("expected calibration error {:.3f} ({:.3f} of (1 + similarity) / 2 as the share)\n",
             error, uncalibrated_error(checked));
  for (const search::ReliabilityBin& bin : bins) {
    if (bin.count == 0) continue;
    fmt::print("  predicted {:3.0f} to {:3.0f} %: {:5.1f} %, right {:5.1f} %  ({} hits)\n",
               100 * bin.low, 100 * bin.high, 100 * bin.predicted, 100 * bin.right, bin.count);
  }
  fmt::print("similarity -> share right:");
  for (const double share : {0.1, 0.25, 0.5, 0.75, 0.9}) {
    const auto& shares = calibration.probabilities();
    const auto at = std::lower_bound(shares.begin(), shares.end(), share);
    if (at == shares.end()) break;
    fmt::print("  {:.3f} -> {:.0f} %",
               calibration.scores()[static_cast<size_t>(at - shares.begin())], 100 * *at);
  }
  fmt::print("\n");
  if (command.store) fmt::print("stored in {}\n", input.files.database_path());
}

}  // namespace remomask::tools
