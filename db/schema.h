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
/// The first version with a log of the changed vectors and of the writers.
constexpr int64_t kLoggingVersion = 3;
/// The first version with checksums of clips, motions and vectors.
constexpr int64_t kChecksumVersion = 4;
/// The first version with vectors of captions.
constexpr int64_t kCaptionVectorVersion = 5;
/// Of the version that keeps guessed captions.
constexpr int64_t kGuessedCaptionVersion = 6;
/// Of the version whose pages have checksums.
constexpr int64_t kPageChecksumVersion = 7;

/// Creates the tables in an empty file.
void create_schema(const SqliteConnection& connection);

/// Throws Error unless the file is a motion database of this or an older version and holds the
/// tables, views and triggers of that version and no others: foreign ones would run along with
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

/// Gives the database a new UUID.
void renew_identity(const SqliteConnection& connection);

/// Whether no table has been created in the file yet.
bool is_empty_database(const SqliteConnection& connection);

}  // namespace remomask::db
