#pragma once

#include <string>
#include <string_view>

namespace remomask {

/// Precedes the tag in the temporary names of files (AtomicFile).
inline constexpr const char* kTemporaryMarker = ".tmp-";

/// The part of a temporary name that identifies its owner: machine and process.
std::string process_tag();

/// Removes from `folder` the files and folders whose names hold `marker` followed by the tag of a
/// process of this machine that no longer runs (and what SQLite adds to such a name). Looks into
/// each folder once per process; what cannot be removed stays.
void remove_leftovers(const std::string& folder, std::string_view marker);

}  // namespace remomask
