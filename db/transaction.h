#pragma once

#include "db/database.h"

namespace remomask::db {

/// All that is stored in `database` during its lifetime is stored together or not at all: commit()
/// keeps it, and an exception or an early return before that undoes it. `database` must outlive it.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) { database_.begin(); }
  ~Transaction() {
    if (open_) database_.rollback();
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;

  void commit() {
    database_.commit();
    open_ = false;
  }

 private:
  Database& database_;
  bool open_ = true;
};

}  // namespace remomask::db
