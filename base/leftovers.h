#pragma once

#include <string>
#include <string_view>

namespace remomask {

/// Stands before the tag in the temporary names of files (AtomicFile).
inline constexpr const char* kTemporaryMarker = ".tmp-";

/// Part of a temporary name that tells whose it is: machine and process.
std::string process_tag();

/// Removes from `folder` the files and folders whose names hold `marker` followed by the tag of a
/// process of this machine that runs no more (and what SQLite adds to such a name). Looks once a
/// process into each folder; what cannot be removed stays.
void remove_leftovers(const std::string& folder, std::string_view marker);

}  // namespace remomask
