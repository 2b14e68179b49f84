#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "exchange/import.h"
#include "tests/db/db_test_tools.h"

namespace remomask {

/// A line of a captions file, with two captions.
std::string caption_line(const std::string& clip, const std::string& split = "train",
                         nlohmann::json labels = nlohmann::json::object());

/// FOLDER/walks with `count` different files and walks.jsonl beside it.
exchange::ImportOptions make_walks(const TestFolder& folder, int count,
                                   const std::string& extension);

bool any_contains(const std::vector<std::string>& texts, const std::string& part);

}  // namespace remomask
