#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "db/database.h"

namespace remomask::search {

/// A label that a clip must have: the value itself, or a member when the label
/// is a list. Dots in the key go into nested labels ("measured.turn") unless a
/// label of the whole name exists. Numbers and booleans compare by value
/// ("true", "0.5").
struct LabelCondition {
  std::string key;
  std::string value;
};

/// "key=value" -> condition. Throws Error when there is no "=" or no key.
LabelCondition parse_label_condition(const std::string& text);

/// Which clips a search may return; all conditions must hold.
struct ClipFilter {
  std::vector<std::string> splits;                 ///< any of these; empty: every split
  std::vector<LabelCondition> labels;              ///< all of these
  std::vector<std::string> tags;                   ///< all of these
  std::vector<std::string> licences;               ///< any of these; empty: every licence
  std::optional<double> min_seconds, max_seconds;  ///< inclusive
  std::optional<double> min_speed, max_speed;      ///< Clip::speed, m/s, inclusive
  std::string caption_query;                       ///< Database::match_captions(); empty: none
  std::set<std::string> excluded_groups;           ///< Clip::group
  std::set<int64_t> excluded_clips;                ///< Clip::id
  bool exclude_mirrored = false;                   ///< leave stored mirror copies out

  bool empty() const;
};

/// Length of a stored clip in seconds.
double clip_seconds(const db::Clip& clip);

/// Ids of the clips that pass, ascending. Throws Error for a split that cannot
/// exist, for a label key, tag or licence that no clip has (a typing mistake
/// would silently find nothing), for a minimum above the maximum, and for a
/// caption query that is none.
std::vector<int64_t> matching_clips(const db::Database& database, const ClipFilter& filter);

/// The same with clips that were read from that state of the database before.
std::vector<int64_t> matching_clips(const db::Database& database,
                                    const std::vector<db::Clip>& clips, const ClipFilter& filter);

/// The same among clips of any origin. A caption query needs the
/// database: throws Error when there is one.
std::vector<int64_t> matching_clips(const std::vector<db::Clip>& clips, const ClipFilter& filter);

}  // namespace remomask::search
