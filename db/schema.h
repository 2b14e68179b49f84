#pragma once

#include "db/sqlite.h"

namespace remomask {

/// Marks a SQLite file as a motion database ("RMMK").
constexpr int64_t kApplicationId = 0x524d4d4b;
constexpr int64_t kSchemaVersion = 1;

/// Makes the tables in an empty file.
void create_schema(const SqliteConnection& connection);

/// Throws Error unless the file is a motion database of this version.
void check_schema(const SqliteConnection& connection);

/// True for a file in which no table was made yet.
bool is_empty_database(const SqliteConnection& connection);

}  // namespace remomask
