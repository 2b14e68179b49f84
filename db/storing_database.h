#pragma once

#include <optional>
#include <string>

#include "db/database.h"

namespace remomask::db {

/// A database for commands that store: it is created if it is missing, and a new one is
/// removed again at the end if nothing was stored in it, for example after an error.
class StoringDatabase {
 public:
  /// Throws Error as Database().
  explicit StoringDatabase(const std::string& path);
  ~StoringDatabase();
  StoringDatabase(const StoringDatabase&) = delete;
  StoringDatabase& operator=(const StoringDatabase&) = delete;

  Database& operator*() { return *database_; }

 private:
  void take_away_unused() const;

  std::string path_;
  bool is_new_;
  std::optional<Database> database_;
};

}  // namespace remomask::db
