#pragma once

#include "db/sqlite.h"

namespace remomask::db {

/// Marks a SQLite file as a motion database ("RMMK").
constexpr int64_t kApplicationId = 0x524d4d4b;
constexpr int64_t kSchemaVersion = 7;
/// To which every writer brings an older file. The step from there, checksums of pages, writes the
/// whole file anew.
constexpr int64_t kUnsealedVersion = 6;
/// Files from this version on can be read without an upgrade.
constexpr int64_t kOldestReadableVersion = 2;
/// Of the version that keeps a log of the changed vectors and of who wrote.
constexpr int64_t kLoggingVersion = 3;
/// Of the version whose clips, motions and vectors have checksums.
constexpr int64_t kChecksumVersion = 4;
/// Of the version that keeps vectors of captions.
constexpr int64_t kCaptionVectorVersion = 5;
/// Of the version that keeps guessed captions.
constexpr int64_t kGuessedCaptionVersion = 6;
/// Of the version whose pages have checksums.
constexpr int64_t kPageChecksumVersion = 7;

/// Makes the tables in an empty file.
void create_schema(const SqliteConnection& connection);

/// Throws Error unless the file is a motion database of this or an older version and holds the
/// tables, views and triggers of that version and no others: those of a stranger would run with
/// our statements.
void check_schema(const SqliteConnection& connection);

/// Brings an older version to kUnsealedVersion in one transaction; `generation`
/// stays, as no clip and no vector changes. Needs a connection that may write.
void upgrade_schema(const SqliteConnection& connection);

/// Writes the whole file anew, with checksums of its pages, and in the present version from then
/// on. Leaves it in WAL mode. A kill leaves the old content or the new one.
void seal_pages(const SqliteConnection& connection);

/// Throws Error that says how to upgrade when the file is too old to be read.
void require_readable_schema(const SqliteConnection& connection);

/// 36 characters as in RFC 4122, version 4.
std::string random_uuid();

/// Gives the database another uuid.
void renew_identity(const SqliteConnection& connection);

/// True for a file in which no table was made yet.
bool is_empty_database(const SqliteConnection& connection);

}  // namespace remomask::db
