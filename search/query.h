#pragma once

#include <optional>
#include <string>
#include <vector>

#include "index/vector_table.h"
#include "remomask/motion.h"
#include "search/filter.h"

namespace remomask::search {

/// What to look for: a sentence, a motion (or a stored clip in its place), or both.
struct SearchQuery {
  std::string text;              ///< "walk -backward": see parse_sentence()
  std::optional<Motion> motion;  ///< canonical, 20 fps, 4 to 200 frames: more like this
  std::string like_clip;         ///< name of a stored clip: more like it
  /// Body parts of the motion that count, see parse_body_parts(); none: the whole body.
  std::vector<std::string> parts;
  double text_weight = 1, motion_weight = 1;  ///< where both are given; not both zero

  /// Clips with any of these words in a caption come up: their ranking by words
  /// (BM25) and that by similarity are joined, see reciprocal_rank_fusion(). Empty: none.
  std::string boost_words;
  double boost_weight = 1;  ///< of the ranking by words; that by similarity has 1

  ClipFilter filter;
  int k = 10;
  bool grouped = true;                     ///< of each Clip::group only the best clip
  std::optional<double> least_similarity;  ///< hits below are refused
  /// The same by MotionHit::probability; of a sentence alone, where the database
  /// keeps a calibration of the retriever.
  std::optional<double> least_probability;
  bool moments = false;  ///< say where in the clip, for the first 50 hits; not with parts
};

/// Numbers of the parts (order of body_parts(), ascending) from their names
/// ("left_arm", ...) or "arms", "legs", "torso". Throws Error for another name.
std::vector<int> parse_body_parts(const std::vector<std::string>& names);

/// What a retriever makes of a query; empty where the query does not have it.
struct QueryVectors {
  std::vector<float> text;                  ///< [E]
  std::vector<float> motion, motion_parts;  ///< [E], [6 P]
};

/// Throws Error for a query that asks for nothing, or for things that exclude
/// each other.
void check_query(const SearchQuery& query);

/// The similarity of a query to clips: cos(text, clip), cos(motion, clip), or
/// where body parts were chosen the mean of their cosines; of sentence and
/// motion together the mean by weight.
index::LinearQuery linear_query(const QueryVectors& vectors, const SearchQuery& query);

/// Seconds [from, to) of a motion (20 fps) as a canonical motion of its own; no
/// `to`: up to its end. Throws Error when nothing is left.
Motion cut_motion(const Motion& motion, double from, const std::optional<double>& to);

}  // namespace remomask::search
