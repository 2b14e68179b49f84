#include "db/snapshot.h"

#include <filesystem>
#include <optional>

#include "base/file.h"
#include "db/page_checksums.h"
#include "db/schema.h"
#include "db/sqlite.h"
#include "remomask/error.h"

namespace remomask::db {

namespace {

namespace fs = std::filesystem;

constexpr int kPagesAtOnce = 1024;

/// Copies all pages in one transaction of `to` (SQLite's online backup).
void copy_pages(const SqliteConnection& from, const SqliteConnection& to, const std::string& stage,
                const Monitor& monitor) {
  // Without it another program's commit would make the copy start again.
  from.execute("BEGIN");
  from.integer("SELECT count(*) FROM sqlite_master");
  if (has_page_checksums(from.handle())) {
    expect_page_checksums(to.handle());
  } else if (has_page_checksums(to.handle())) {
    throw Error(to.path() + ": its pages have checksums and those of " + from.path() +
                " do not; run: remomask db upgrade " + from.path());
  }
  sqlite3_backup* backup = sqlite3_backup_init(to.handle(), "main", from.handle(), "main");
  if (!backup) to.fail();
  int code = SQLITE_OK;
  bool stopped = false;
  while (code == SQLITE_OK && !stopped) {
    code = sqlite3_backup_step(backup, kPagesAtOnce);
    const int total = sqlite3_backup_pagecount(backup);
    if (total > 0) {
      monitor.report({stage, static_cast<double>(total - sqlite3_backup_remaining(backup)),
                      static_cast<double>(total), "pages"});
    }
    stopped = code == SQLITE_OK && monitor.stop_requested();
  }
  // Without the last step this rolls everything back.
  const int finished = sqlite3_backup_finish(backup);
  from.execute("COMMIT");
  if (stopped) throw Interrupted(stage + " was stopped; nothing was changed");
  if (code != SQLITE_DONE) to.fail(code);
  if (finished != SQLITE_OK) to.fail(finished);
}

void require_free(const std::string& path, bool replace) {
  if (fs::exists(path) && !replace) {
    throw FileError(path, 0, "exists already; name another file, or say --force to replace it");
  }
  if (fs::is_directory(path)) throw FileError(path, 0, "is a folder; name a file");
}

/// One file without a log beside it, wherever it is put.
void keep_no_log(const SqliteConnection& connection) {
  connection.execute("PRAGMA journal_mode = DELETE");
}

bool is_damage(int code) {
  return code == SQLITE_IOERR_DATA || (code & 0xff) == SQLITE_CORRUPT ||
         (code & 0xff) == SQLITE_NOTADB;
}

bool has_log(const std::string& path) {
  return fs::exists(path + "-wal") || fs::exists(path + "-journal");
}

/// Takes in the log beside a database that nobody has open, as one that was merely read leaves it.
void take_in_log(const std::string& path) {
  try {
    const SqliteConnection connection(path, SqliteMode::read_write);
    keep_no_log(connection);
  } catch (const Error&) {
    // In use, or no database: the log stays, and the caller says so.
  }
}

/// True when SQLite can replace the content of the file in a transaction.
bool can_be_written(const std::string& path) {
  const SqliteConnection probe(path, SqliteMode::read_write);
  // A log that a killed program left is taken in now, or found to be broken.
  const int code =
      sqlite3_exec(probe.handle(), "BEGIN IMMEDIATE; ROLLBACK", nullptr, nullptr, nullptr);
  if (code == SQLITE_OK) return true;
  if (is_damage(sqlite3_extended_errcode(probe.handle()))) return false;
  probe.fail();
}

/// Moves a file with its logs out of the way.
std::string set_aside(const std::string& path) {
  std::string place = path + ".damaged";
  for (int number = 2; fs::exists(place); ++number) {
    place = path + ".damaged" + std::to_string(number);
  }
  // The logs first: a log without its database is ignored, a new database with
  // the log of an old one would be destroyed by it.
  for (const char* ending : {"-wal", "-journal", "-shm", ""}) {
    if (fs::exists(path + ending)) fs::rename(path + ending, place + ending);
  }
  return place;
}

}  // namespace

void snapshot_database(const std::string& path, const std::string& target, bool replace,
                       const Monitor& monitor) {
  require_free(target, replace);
  if (fs::exists(target) && fs::equivalent(path, target)) {
    throw FileError(target, 0, "is the database itself; name another file");
  }
  if (has_log(target)) take_in_log(target);
  if (has_log(target)) {
    throw FileError(target, 0, "is in use, there is a log beside it; name another file");
  }
  AtomicFile file(target);
  {
    const SqliteConnection from(path, SqliteMode::read_only);
    check_schema(from);
    const SqliteConnection to(file.temporary_path(), SqliteMode::create);
    copy_pages(from, to, "snapshot of " + path, monitor);
    keep_no_log(to);
  }
  file.commit();
}

RestoreReport restore_database(const std::string& snapshot, const std::string& path, bool replace,
                               const Monitor& monitor) {
  require_free(path, replace);
  if (fs::exists(path) && fs::equivalent(path, snapshot)) {
    throw FileError(path, 0, "is the snapshot itself; name another file");
  }
  RestoreReport report;
  AtomicFile file(path);
  std::optional<SqliteConnection> copy;
  {
    const SqliteConnection from(snapshot, SqliteMode::read_only);
    check_schema(from);
    copy.emplace(file.temporary_path(), SqliteMode::create);
    copy_pages(from, *copy, "restore " + snapshot, monitor);
  }
  keep_no_log(*copy);
  {
    SqliteStatement check(*copy, "PRAGMA integrity_check(1)");
    check.step();
    if (check.text(0) != "ok") {
      throw Error(snapshot + ": the snapshot is damaged (" + check.text(0) + "); take another");
    }
  }
  upgrade_schema(*copy);
  if (!has_page_checksums(copy->handle())) {
    seal_pages(*copy);
    keep_no_log(*copy);
  }
  renew_identity(*copy);
  if (fs::exists(path) && can_be_written(path)) {
    const SqliteConnection to(path, SqliteMode::read_write);
    if (!is_empty_database(to) && to.integer("PRAGMA application_id") != kApplicationId) {
      throw Error(path + ": belongs to another program; name another file");
    }
    // A rollback journal would be played back without room for checksums onto pages that have it.
    to.execute("PRAGMA journal_mode = WAL");
    copy_pages(*copy, to, "restore " + path, monitor);
    return report;
  }
  copy->execute("PRAGMA journal_mode = WAL");
  copy.reset();
  if (fs::exists(path) || has_log(path)) report.set_aside = set_aside(path);
  file.commit();
  return report;
}

}  // namespace remomask::db
