#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "db/database.h"
#include "remomask/search.h"

namespace remomask::db {

/// Parses "key=value". Throws Error if the "=" or the key is missing.
LabelCondition parse_label_condition(const std::string& text);

/// Whether a clip's labels satisfy a condition.
bool has_label(const nlohmann::json& labels, const LabelCondition& condition);

/// Ids of the clips that pass the filter, ascending. Throws Error for an unknown split,
/// for a label key, tag or licence that no clip has (a typing mistake
/// would silently find nothing), for a minimum above the maximum, and for a
/// malformed caption query.
std::vector<int64_t> matching_clips(const Database& database, const ClipFilter& filter);

/// The same for clips that were already read from this state of the database.
std::vector<int64_t> matching_clips(const Database& database, const std::vector<Clip>& clips,
                                    const ClipFilter& filter);

/// The same for clips of any origin. A caption query needs the database, so a filter with one
/// throws Error.
std::vector<int64_t> matching_clips(const std::vector<Clip>& clips, const ClipFilter& filter);

}  // namespace remomask::db
