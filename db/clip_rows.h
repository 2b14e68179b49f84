#pragma once

#include <vector>

#include "db/database.h"
#include "db/sqlite.h"

namespace remomask::db {

/// What to do about a damaged clip; ends a message.
inline constexpr const char* kReplaceClip =
    "remove the clip and add its file again, or restore a snapshot";

/// Whether every value is a plausible number of metres; false for NaN.
bool all_near(const std::vector<float>& positions);

/// All clips with their captions and tags, by id. Throws Error that names a clip whose row,
/// captions or tags differ from its checksum.
std::vector<Clip> read_clips(const SqliteConnection& connection);

/// One of them. Throws Error for an unknown id, or as read_clips().
Clip read_clip(const SqliteConnection& connection, int64_t id);

/// Why a clip differs from its checksum; empty if it does not, or if the format has none.
std::string clip_damage(const SqliteConnection& connection, int64_t id);

/// Stores the checksum of a clip as it is now, or of every clip.
void store_clip_checksum(const SqliteConnection& connection, int64_t id);
void store_clip_checksums(const SqliteConnection& connection);

}  // namespace remomask::db
