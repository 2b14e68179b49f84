#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace remomask::search {

/// The share of hits with a similarity that is right: a table that never falls.
class Calibration {
 public:
  Calibration() = default;

  /// Share in [0, 1]; linear between the scores of the table, constant outside.
  /// The calibration must not be empty.
  double probability(double score) const;

  bool empty() const { return scores_.empty(); }
  const std::vector<double>& scores() const { return scores_; }  ///< ascending
  const std::vector<double>& probabilities() const { return probabilities_; }
  int64_t pairs() const { return pairs_; }  ///< that it was fitted to

 private:
  friend Calibration fit_calibration(const std::vector<double>& scores,
                                     const std::vector<bool>& right);
  friend Calibration parse_calibration(const nlohmann::json& json);

  std::vector<double> scores_, probabilities_;
  int64_t pairs_ = 0;
};

/// Isotonic regression of `right` on `scores` (least squares, pool adjacent violators; Zadrozny and
/// Elkan 2002): each block of equal value contributes its smallest and its largest score to the
/// table. Throws Error for no pairs, different numbers of both, or scores that are not finite.
Calibration fit_calibration(const std::vector<double>& scores, const std::vector<bool>& right);

void to_json(nlohmann::json& json, const Calibration& calibration);
/// Throws Error for anything that to_json() does not write.
Calibration parse_calibration(const nlohmann::json& json);

/// The name under which a database keeps the calibration of a retriever (a fact with the JSON
/// text).
std::string calibration_fact(const std::string& retriever_hash);

/// Predictions whose probability lies in one of equally wide bins of [0, 1].
struct ReliabilityBin {
  double low = 0, high = 0;
  double predicted = 0;  ///< mean probability
  double right = 0;      ///< share that is right
  int64_t count = 0;
};

/// `bins` bins, including the empty ones; 1 belongs to the last.
std::vector<ReliabilityBin> reliability_bins(const std::vector<double>& probabilities,
                                             const std::vector<bool>& right, int bins = 10);

/// Mean of |predicted - right| over the bins, weighted by their counts (ECE;
/// Guo et al., ICML 2017); 0 without predictions.
double expected_calibration_error(const std::vector<ReliabilityBin>& bins);

}  // namespace remomask::search
