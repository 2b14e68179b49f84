#pragma once

#include <optional>
#include <string>

#include "db/database.h"

namespace remomask::db {

/// What the licence of a data set asks to be said of its clips. It is stored with
/// them, so that a copy of the database carries it.
std::optional<std::string> attribution(const Database& database, const std::string& source);

/// Replaces it; an empty text removes it. Throws Error when no clip is of `source`
/// and for text that is not UTF-8.
void set_attribution(Database& database, const std::string& source, const std::string& text);

/// Adds a text to what is there, in a line of its own, unless it says so already.
void add_attribution(Database& database, const std::string& source, const std::string& text);

}  // namespace remomask::db
