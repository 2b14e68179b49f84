#include "search/calibration.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "remomask/error.h"

namespace remomask::search {

namespace {

/// Scores that share one value of the regression.
struct IsotonicBlock {
  double low, high, right, count;
  double mean() const { return right / count; }
};

}  // namespace

double Calibration::probability(double score) const {
  if (empty()) throw Error("there is no calibration; fit one first");
  const auto above = std::upper_bound(scores_.begin(), scores_.end(), score);
  if (above == scores_.begin()) return probabilities_.front();
  if (above == scores_.end()) return probabilities_.back();
  const auto i = static_cast<size_t>(above - scores_.begin());
  const double weight = (score - scores_[i - 1]) / (scores_[i] - scores_[i - 1]);
  return (1 - weight) * probabilities_[i - 1] + weight * probabilities_[i];
}

Calibration fit_calibration(const std::vector<double>& scores, const std::vector<bool>& right) {
  if (scores.empty() || scores.size() != right.size()) {
    throw Error("a calibration needs pairs of a score and whether it was right");
  }
  for (const double score : scores) {
    if (!std::isfinite(score)) throw Error("a score to calibrate is not a finite number");
  }
  std::vector<size_t> order(scores.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return scores[a] < scores[b]; });
  std::vector<IsotonicBlock> blocks;
  for (size_t first = 0; first < order.size();) {
    // Equal scores have one value, so they enter together.
    IsotonicBlock block{scores[order[first]], scores[order[first]], 0, 0};
    for (; first < order.size() && scores[order[first]] == block.low; ++first) {
      block.right += right[order[first]] ? 1 : 0;
      block.count += 1;
    }
    while (!blocks.empty() && blocks.back().mean() >= block.mean()) {
      block.low = blocks.back().low;
      block.right += blocks.back().right;
      block.count += blocks.back().count;
      blocks.pop_back();
    }
    blocks.push_back(block);
  }
  Calibration calibration;
  calibration.pairs_ = static_cast<int64_t>(scores.size());
  for (const IsotonicBlock& block : blocks) {
    calibration.scores_.push_back(block.low);
    calibration.probabilities_.push_back(block.mean());
    if (block.high == block.low) continue;
    calibration.scores_.push_back(block.high);
    calibration.probabilities_.push_back(block.mean());
  }
  return calibration;
}

void to_json(nlohmann::json& json, const Calibration& calibration) {
  json = {{"scores", calibration.scores()},
          {"probabilities", calibration.probabilities()},
          {"pairs", calibration.pairs()}};
}

Calibration parse_calibration(const nlohmann::json& json) {
  Calibration calibration;
  try {
    calibration.scores_ = json.at("scores").get<std::vector<double>>();
    calibration.probabilities_ = json.at("probabilities").get<std::vector<double>>();
    calibration.pairs_ = json.at("pairs").get<int64_t>();
  } catch (const nlohmann::json::exception& error) {
    throw Error(std::string("this is not a calibration: ") + error.what());
  }
  const auto rising = [](const std::vector<double>& values, bool strictly) {
    const auto violation =
        std::adjacent_find(values.begin(), values.end(),
                           [&](double a, double b) { return strictly ? b <= a : b < a; });
    return violation == values.end();
  };
  const std::vector<double>& shares = calibration.probabilities_;
  if (calibration.scores_.empty() || calibration.scores_.size() != shares.size() ||
      !rising(calibration.scores_, true) || !rising(shares, false) || shares.front() < 0 ||
      shares.back() > 1) {
    throw Error("this is not a calibration: scores must rise and shares must not fall from 0 to 1");
  }
  return calibration;
}

std::string calibration_fact(const std::string& retriever_hash) {
  return "calibration " + retriever_hash;
}

std::vector<ReliabilityBin> reliability_bins(const std::vector<double>& probabilities,
                                             const std::vector<bool>& right, int bins) {
  if (bins < 1 || probabilities.size() != right.size()) {
    throw Error("a reliability diagram needs bins, and pairs of a probability and its outcome");
  }
  std::vector<ReliabilityBin> result(static_cast<size_t>(bins));
  for (int b = 0; b < bins; ++b) {
    result[static_cast<size_t>(b)].low = static_cast<double>(b) / bins;
    result[static_cast<size_t>(b)].high = static_cast<double>(b + 1) / bins;
  }
  for (size_t i = 0; i < probabilities.size(); ++i) {
    const int place = static_cast<int>(std::floor(probabilities[i] * bins));
    ReliabilityBin& bin = result[static_cast<size_t>(std::clamp(place, 0, bins - 1))];
    bin.predicted += probabilities[i];
    bin.right += right[i] ? 1 : 0;
    ++bin.count;
  }
  for (ReliabilityBin& bin : result) {
    if (bin.count == 0) continue;
    bin.predicted /= static_cast<double>(bin.count);
    bin.right /= static_cast<double>(bin.count);
  }
  return result;
}

double expected_calibration_error(const std::vector<ReliabilityBin>& bins) {
  double error = 0, count = 0;
  for (const ReliabilityBin& bin : bins) {
    error += static_cast<double>(bin.count) * std::abs(bin.predicted - bin.right);
    count += static_cast<double>(bin.count);
  }
  return count > 0 ? error / count : 0;
}

}  // namespace remomask::search
