#include "tests/torture/folder_state.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "base/file.h"
#include "base/hash.h"
#include "db/check.h"
#include "db/database.h"
#include "db/schema.h"
#include "db/sqlite.h"
#include "formats/motion_reading.h"
#include "formats/sidecar.h"
#include "index/index_file.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"

namespace remomask {

namespace {

namespace fs = std::filesystem;

std::string hash_of(const std::vector<float>& values) {
  return content_hash(
      {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
}

/// A new database whose first transaction was never finished is an empty file.
bool is_unmade(const std::string& path) {
  return fs::file_size(path) == 0 ||
         db::is_empty_database(db::SqliteConnection(path, db::SqliteMode::read_only));
}

std::string database_state(const std::string& path) {
  if (is_unmade(path)) return "unmade";
  const db::Database database(path, db::OpenMode::read_only);
  nlohmann::json all;
  for (const db::Clip& clip : database.clips()) {
    nlohmann::json& one = all["clips"][clip.name];
    one = {clip.source,      clip.source_file,
           clip.start_frame, clip.split,
           clip.licence,     clip.group,
           clip.captions,    clip.labels,
           clip.tags,        hash_of(database.motion(clip.id).positions)};
    for (const std::string& retriever : database.retrievers()) {
      const auto vectors = database.embedding(retriever, clip.id);
      if (!vectors) continue;
      one.push_back(
          {retriever, hash_of(vectors->motion), hash_of(vectors->parts), hash_of(vectors->text)});
    }
  }
  for (const std::string& encoder : database.caption_encoders()) {
    for (const db::CaptionVector& one : database.caption_vectors(encoder)) {
      all["captions"][one.text] = hash_of(one.vector);
    }
  }
  const db::SqliteConnection connection(path, db::SqliteMode::read_only);
  db::SqliteStatement facts(connection,
                            "SELECT key, value FROM fact WHERE key NOT IN "
                            "('uuid', 'generation', 'changes_since') ORDER BY key");
  while (facts.step()) all["facts"][facts.text(0)] = facts.text(1);
  all["format"] = connection.integer("PRAGMA user_version");
  return all.dump();
}

std::string index_state(const std::string& path) {
  std::string ids;
  for (const int64_t id : index::read_index_file(path).header.ids) ids += std::to_string(id) + " ";
  return ids;
}

/// The library that writes FBX notes the time in the file.
std::string fbx_state(const std::string& path) {
  return hash_of(load_motion(path).motion.positions);
}

/// What SQLite keeps beside a database that is open.
bool is_log(const std::string& name) {
  return name.ends_with(".sqlite-wal") || name.ends_with(".sqlite-shm");
}

template <typename Visit>
void visit_files(const std::string& folder, const Visit& visit) {
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      visit(entry.path().string(), fs::relative(entry.path(), folder).string());
    }
  }
}

}  // namespace

std::string state_of(const std::string& folder) {
  std::set<std::string> lines;
  visit_files(folder, [&](const std::string& path, const std::string& name) {
    if (is_log(name)) return;
    lines.insert(name + ": " +
                 (name.ends_with(".sqlite")  ? database_state(path)
                  : name.ends_with(".index") ? index_state(path)
                  : name.ends_with(".fbx")   ? fbx_state(path)
                                             : content_hash(read_file(path))));
  });
  std::string state;
  for (const std::string& line : lines) state += line + "\n";
  return state;
}

std::string damage_in(const std::string& folder) {
  std::string damage;
  visit_files(folder, [&](const std::string& path, const std::string& name) {
    try {
      if (name.ends_with(".sqlite") && !is_unmade(path)) {
        for (const db::Defect& defect : db::check_database(path).defects) {
          damage += name + ": " + defect.what + "\n";
        }
      }
      if (formats::is_readable_motion(path)) formats::read_sidecar(path);
    } catch (const Error& error) {
      const std::string what = error.what();
      // Version 1 is not read as it is.
      const bool old = what.find("remomask db upgrade") != std::string::npos;
      if (!old) damage += what + "\n";
    }
  });
  return damage;
}

std::string leftovers_in(const std::string& folder) {
  std::string found;
  visit_files(folder, [&](const std::string&, const std::string& name) {
    if (name.find(".tmp-") != std::string::npos || name.ends_with("-journal")) found += name + " ";
  });
  return found;
}

}  // namespace remomask
