#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "db/database.h"
#include "remomask/search.h"

namespace remomask::db {

/// "key=value" -> condition. Throws Error when there is no "=" or no key.
LabelCondition parse_label_condition(const std::string& text);

/// Whether a clip's labels answer a condition.
bool has_label(const nlohmann::json& labels, const LabelCondition& condition);

/// Ids of the clips that pass, ascending. Throws Error for a split that cannot
/// exist, for a label key, tag or licence that no clip has (a typing mistake
/// would silently find nothing), for a minimum above the maximum, and for a
/// caption query that is none.
std::vector<int64_t> matching_clips(const Database& database, const ClipFilter& filter);

/// The same with clips that were read from that state of the database before.
std::vector<int64_t> matching_clips(const Database& database, const std::vector<Clip>& clips,
                                    const ClipFilter& filter);

/// The same among clips of any origin. A caption query needs the
/// database: throws Error when there is one.
std::vector<int64_t> matching_clips(const std::vector<Clip>& clips, const ClipFilter& filter);

}  // namespace remomask::db
