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

/// What a search by sentence compares the sentence with.
enum class SearchBy {
  all,       ///< captions, words and motions together: the probability that a clip is right
  captions,  ///< the captions by their meaning
  words,     ///< the captions by their words (BM25)
  motion,    ///< the motions, by the retriever; captions are not read
};

/// Name of the enumerator: "all", "captions", ...
REMOMASK_API const char* search_by_name(SearchBy by);
/// Throws Error for another name.
REMOMASK_API SearchBy parse_search_by(const std::string& name);

/// What to look for: a sentence, a motion (or a stored clip in its place), or both.
struct SearchQuery {
  std::string text;              ///< "walk -backward": a word after a minus is unwanted
  SearchBy by = SearchBy::all;   ///< of a sentence alone; with a motion, motions are compared
  std::optional<Motion> motion;  ///< canonical, 20 fps, 4 to 200 frames: find similar clips
  std::string like_clip;         ///< name of a stored clip: find similar clips
  /// Body parts of the motion to compare: "left_arm", "right_arm", "arms", "left_leg",
  /// "right_leg", "legs", "upper_spine_head", "root_lower_spine", "torso". Empty: whole body.
  std::vector<std::string> parts;
  /// Used if both a sentence and a motion are given; they must not both be zero.
  double text_weight = 1, motion_weight = 1;

  /// In a search that compares motions, clips with any of these words in a caption move up: their
  /// ranking by words (BM25) is fused with the ranking by similarity. Empty: no boost.
  std::string boost_words;
  double boost_weight = 1;  ///< of the ranking by words; the ranking by similarity has 1

  ClipFilter filter;
  int k = 10;  ///< maximum number of hits
  /// In a search by words, a sentence that names a side also finds the mirror images of clips.
  bool mirror = true;
  bool grouped = true;                   ///< return only the best clip of each group
  std::optional<double> min_similarity;  ///< hits below it are refused
  /// Hits below this MotionHit::probability are refused. Only where hits have one.
  std::optional<double> min_probability;
  bool moments = false;  ///< locate the query in the first 50 hits; not with `parts`
};

/// A stretch of a clip.
struct HitMoment {
  double start = 0, end = 0;  ///< seconds from the start of the clip
  double similarity = 0;      ///< of the query and this stretch
};

/// What a sentence has in common with a clip. Unset: not compared.
struct WordParts {
  std::string caption;           ///< the one that is nearest to the sentence; empty: none
  std::optional<double> best;    ///< cosine of the sentence and that caption
  std::optional<double> mean;    ///< mean cosine over the captions
  double words = 0;              ///< BM25, divided by that of the clip with the best; 0: no word
  double share = 0;              ///< of the sentence's words, by weight, that its captions have
  std::optional<double> motion;  ///< cosine of the sentence and the motion, by the retriever
  /// Set: nobody has described the clip, and the caption is a guess that is right with this
  /// probability.
  std::optional<double> guess;
};

struct MotionHit {
  int rank = 0;  ///< from 1
  ClipInfo clip;
  /// Of query and clip, -1 to 1: the cosine with the motion; in a search by captions or words that
  /// of the nearest caption or the share of the best BM25.
  float similarity = 0;
  /// Estimated probability that the clip shows what was asked for. Of a sentence alone: by what
  /// SearchBy::all compares; by SearchBy::motion only in a database that stores a calibration.
  std::optional<double> probability;
  /// The clip shows it when it is mirrored: the sentence asks for the other side.
  bool as_mirrored = false;
  std::optional<WordParts> parts;   ///< of a sentence alone, unless only motions were compared
  std::optional<HitMoment> moment;  ///< set if SearchQuery::moments was
  int folded = 0;  ///< further clips of the same group that pass the filter but are not listed
};

/// A word of the sentence that means something by itself.
struct QueryWord {
  std::string word;
  double covered = 0;        ///< probability that the best hits' captions say it, in any words
  bool in_captions = false;  ///< a caption of these has the same word, in any of its forms
};

/// A word that was read as another one, since it looks like a typing error.
struct CorrectedWord {
  std::string typed, read;
};

/// From this QueryWord::covered on, a word counts as found.
inline constexpr double kCoveredWord = 0.5;

struct SearchAnswer {
  std::vector<MotionHit> hits;   ///< best first
  std::vector<QueryWord> words;  ///< of a sentence, in its order; none in a search by motion
  std::vector<CorrectedWord> corrected;
  std::string sentence;  ///< as it was read; empty: as it was typed
  /// The language that the sentence seems to be in, "Spanish" or "another language", if that is not
  /// English, which is all that is understood.
  std::string language;
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
