#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "db/database.h"

namespace remomask::tools {

/// What a database holds: identity, counts of clips by split, source, licence
/// and tag, the attributions that its data sets ask for, and which retrievers have embedded how
/// many clips.
nlohmann::json describe_database(const std::string& path);

/// One clip without its positions.
nlohmann::json clip_json(const db::Clip& clip);

/// A JSON object for people: a line a member, nested objects indented.
void print_description(const nlohmann::json& document);

}  // namespace remomask::tools
