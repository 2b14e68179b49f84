#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "db/database.h"

namespace remomask::search {

/// A stretch of a clip.
struct HitMoment {
  double start = 0, end = 0;  ///< seconds from the start of the clip
  double similarity = 0;      ///< of the query to this stretch
};

struct MotionHit {
  int rank = 0;  ///< from 1
  db::Clip clip;
  float similarity = 0;  ///< to the query, -1 .. 1, see linear_query()
  /// Share of hits of this similarity that are right, of a sentence alone and
  /// where the database keeps a calibration of the retriever.
  std::optional<double> probability;
  std::optional<HitMoment> moment;  ///< where in the clip, when it was asked for
  int folded = 0;  ///< further clips of its group that pass the filter and are not listed
};

struct SearchAnswer {
  std::vector<MotionHit> hits;       ///< best first
  int64_t candidates = 0;            ///< clips that pass the filter
  int64_t boosted = 0;               ///< of them with one of the boost words
  int64_t unsearched = 0;            ///< clips that the retriever has not embedded yet
  std::optional<MotionHit> refused;  ///< the most similar clip that a limit kept out
};

struct CaptionHit {
  int rank = 0;
  std::string caption;
  float similarity = 0;            ///< cosine of motion and caption
  std::vector<std::string> clips;  ///< names of the near clips that have it
};

}  // namespace remomask::search
