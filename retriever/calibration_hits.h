#pragma once

#include <vector>

#include "retriever/calibration.h"
#include "retriever/retrieval_metrics.h"

namespace remomask {

/// Hits of text-to-motion search with their similarity and whether they are right.
struct JudgedHits {
  std::vector<double> similarities;
  std::vector<bool> right;
};

/// The `depth` clips most similar to each text of the split, ties to the lower
/// number. A hit is right by the rule of RetrievalProtocol::duplicates, or when
/// its labels content and style are those of the text's clip.
JudgedHits judge_hits(const EncodedSplit& split, const std::vector<TrainingClip>& clips,
                      int64_t depth = 10);

/// Shares that a calibration predicts for hits.
std::vector<double> predicted_shares(const Calibration& calibration, const JudgedHits& hits);

}  // namespace remomask
