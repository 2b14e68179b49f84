#pragma once

#include <string>
#include <vector>

#include "search/calibration.h"

namespace remomask::evaluation {

/// What a reliability diagram shows.
struct ReliabilityPicture {
  std::string heading;                       ///< for example the splits
  std::string scored = "similarity";         ///< what the table is over
  std::string note;                          ///< below it, for example pairs and error
  search::Calibration calibration;           ///< drawn over the similarities
  std::vector<search::ReliabilityBin> bins;  ///< drawn over the predicted share
  std::vector<double> similarities;          ///< of the checked pairs, drawn as a histogram
};

/// Two panels side by side as PNG: the calibration table over the similarity, or another score,
/// with how often each occurs, and the share that is right against
/// the predicted share with the diagonal that a perfect calibration has; the
/// area of a point is its number of pairs. Written atomically.
void write_reliability_diagram(const std::string& png_path, const ReliabilityPicture& picture);

}  // namespace remomask::evaluation
