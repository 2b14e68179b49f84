#pragma once

#include <vector>

#include "evaluation/retrieval_metrics.h"
#include "search/calibration.h"

namespace remomask::evaluation {

/// Hits of text-to-motion search with their similarity and whether they are right.
struct JudgedHits {
  std::vector<double> similarities;
  std::vector<bool> right;
};

/// The `depth` clips most similar to each text of the split, ties to the lower
/// number. A hit is right by the rule of RetrievalProtocol::duplicates, or when
/// its labels content and style are those of the text's clip.
JudgedHits judge_hits(const EncodedSplit& split, const std::vector<db::TrainingClip>& clips,
                      int64_t depth = 10);

/// Shares that a calibration predicts for hits.
std::vector<double> predicted_shares(const search::Calibration& calibration,
                                     const JudgedHits& hits);

}  // namespace remomask::evaluation
