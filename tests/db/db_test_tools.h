#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "db/database.h"
#include "remomask/error.h"
#include "remomask/motion.h"

namespace remomask {

/// A folder of its own for one test, removed afterwards.
class TestFolder {
 public:
  TestFolder();
  ~TestFolder() { std::filesystem::remove_all(path_); }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

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

/// Runs SQL behind the back of the program.
void run_sql(const std::string& path, const char* sql);

/// All clips of a database without the fields that the order of storing gives.
nlohmann::json describe_database(const db::Database& database);

}  // namespace remomask
