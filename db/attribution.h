#pragma once

#include <optional>
#include <string>

#include "db/database.h"

namespace remomask::db {

/// The attribution that the licence of a data set requires. It is stored in the database, so that
/// every copy carries it.
std::optional<std::string> attribution(const Database& database, const std::string& source);

/// Replaces the attribution; an empty text removes it. Throws Error if no clip belongs to `source`
/// or if the text is not UTF-8.
void set_attribution(Database& database, const std::string& source, const std::string& text);

/// Appends a line to the attribution unless it already contains it.
void add_attribution(Database& database, const std::string& source, const std::string& text);

}  // namespace remomask::db
