#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "remomask/clip.h"
#include "remomask/export.h"
#include "remomask/motion.h"

namespace remomask {

/// A label that a clip must have: the value itself, or a member if the label is a list. Dots
/// in the key reach into nested labels ("measured.turn") unless a label has the whole name.
/// Numbers and booleans are compared by value ("true", "0.5").
struct LabelCondition {
  std::string key;
  std::string value;
};

/// Which clips a search may return. All conditions must hold.
struct REMOMASK_API ClipFilter {
  std::vector<std::string> splits;                 ///< any of these; empty: every split
  std::vector<LabelCondition> labels;              ///< all of these
  std::vector<std::string> tags;                   ///< all of these
  std::vector<std::string> licences;               ///< any of these; empty: every licence
  std::optional<double> min_seconds, max_seconds;  ///< inclusive
  std::optional<double> min_speed, max_speed;      ///< ClipInfo::speed, m/s, inclusive
  std::string caption_query;                       ///< full-text query (FTS5); empty: none
  std::set<std::string> excluded_groups;           ///< ClipInfo::group
  std::set<int64_t> excluded_clips;                ///< ClipInfo::id
  bool exclude_mirrored = false;                   ///< leave out stored mirror copies

  bool empty() const;
};

/// What to look for: a sentence, a motion (or a stored clip in its place), or both.
struct SearchQuery {
  std::string text;              ///< "walk -backward": a word after a minus is unwanted
  std::optional<Motion> motion;  ///< canonical, 20 fps, 4 to 200 frames: find similar clips
  std::string like_clip;         ///< name of a stored clip: find similar clips
  /// Body parts of the motion to compare: "left_arm", "right_arm", "arms", "left_leg",
  /// "right_leg", "legs", "upper_spine_head", "root_lower_spine", "torso". Empty: whole body.
  std::vector<std::string> parts;
  /// Used if both a sentence and a motion are given; they must not both be zero.
  double text_weight = 1, motion_weight = 1;

  /// Clips with any of these words in a caption move up: their ranking by words (BM25) is
  /// fused with the ranking by similarity. Empty: no boost.
  std::string boost_words;
  double boost_weight = 1;  ///< of the ranking by words; the ranking by similarity has 1

  ClipFilter filter;
  int k = 10;                            ///< maximum number of hits
  bool grouped = true;                   ///< return only the best clip of each group
  std::optional<double> min_similarity;  ///< hits below it are refused
  /// Hits below this MotionHit::probability are refused. Only for a query by sentence alone
  /// in a database that stores a calibration of the retriever.
  std::optional<double> min_probability;
  bool moments = false;  ///< locate the query in the first 50 hits; not with `parts`
};

/// A stretch of a clip.
struct HitMoment {
  double start = 0, end = 0;  ///< seconds from the start of the clip
  double similarity = 0;      ///< of the query and this stretch
};

struct MotionHit {
  int rank = 0;  ///< from 1
  ClipInfo clip;
  float similarity = 0;  ///< of query and clip, -1 to 1
  /// Estimated probability that a hit of this similarity is right. Only for a query by
  /// sentence alone in a database that stores a calibration of the retriever.
  std::optional<double> probability;
  std::optional<HitMoment> moment;  ///< set if SearchQuery::moments was
  int folded = 0;  ///< further clips of the same group that pass the filter but are not listed
};

struct SearchAnswer {
  std::vector<MotionHit> hits;       ///< best first
  int64_t candidates = 0;            ///< clips that pass the filter
  int64_t boosted = 0;               ///< of these, clips with one of the boost words
  int64_t unsearched = 0;            ///< clips that the retriever has not embedded yet
  std::optional<MotionHit> refused;  ///< the most similar clip below a minimum
};

struct CaptionHit {
  int rank = 0;  ///< from 1
  std::string caption;
  float similarity = 0;            ///< cosine of motion and caption
  std::vector<std::string> clips;  ///< names of the similar clips with this caption
};

}  // namespace remomask
