#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "db/database.h"
#include "remomask/error.h"
#include "remomask/motion.h"
#include "tests/base/test_folder.h"

namespace remomask {

/// A standing body that walks and swings its arms, different for every seed:
/// canonical, 22 joints.
Motion walking_motion(int frames, int seed);

/// A clip with this name and sensible other fields.
db::Clip named_clip(const std::string& name);

/// What `function` throws as Error; "" when it does not.
template <typename Function>
std::string error_of(Function function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Runs SQL behind the back of the program; only the checksums of pages follow.
void run_sql(const std::string& path, const char* sql);

/// All clips of a database without the fields that the order of storing gives.
nlohmann::json describe_database(const db::Database& database);

}  // namespace remomask
