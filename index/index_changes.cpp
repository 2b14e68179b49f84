#include "index/index_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <iterator>

#include "base/file.h"
#include "base/hash.h"
#include "index/described_file.h"
#include "index/exact_scan.h"
#include "remomask/error.h"

namespace remomask::index {

namespace {

constexpr size_t kDescriptionRoom = 1024;  // a description is shorter: no second allocation
constexpr std::string_view kDeltaMagic = "RMMDELTA";
constexpr double kFoldShareOfExact = 0.10, kFoldShareOfApproximate = 0.02;
constexpr const char* kUpdate = "run: remomask index DB";

using Ids = std::vector<int64_t>;

Ids ids_without(const Ids& left, const Ids& right) {
  Ids result;
  std::set_difference(left.begin(), left.end(), right.begin(), right.end(),
                      std::back_inserter(result));
  return result;
}

/// The added clips that are still wanted, and the missing ones, by id.
void replace_added(IndexChanges& changes, const Ids& wanted, const Ids& missing,
                   const std::vector<float>& missing_vectors, int width) {
  std::vector<float> vectors;
  vectors.reserve(wanted.size() * static_cast<size_t>(width));
  auto known = changes.added.begin();
  auto found = missing.begin();
  for (const int64_t id : wanted) {
    known = std::lower_bound(known, changes.added.end(), id);
    found = std::lower_bound(found, missing.end(), id);
    const bool is_new = found != missing.end() && *found == id;
    const auto row = is_new ? found - missing.begin() : known - changes.added.begin();
    const auto source = (is_new ? missing_vectors : changes.vectors).begin() + row * width;
    vectors.insert(vectors.end(), source, source + width);
  }
  changes.added = wanted;
  changes.vectors = std::move(vectors);
}

Ids common_ids(const Ids& left, const Ids& right) {
  Ids result;
  std::set_intersection(left.begin(), left.end(), right.begin(), right.end(),
                        std::back_inserter(result));
  return result;
}

/// Of lists that have no id in common.
Ids merged_ids(const Ids& left, const Ids& right) {
  Ids result(left.size() + right.size());
  std::merge(left.begin(), left.end(), right.begin(), right.end(), result.begin());
  return result;
}

/// Among others, the clips whose vectors were added or removed since the stamp.
db::EmbeddingChanges changed_clips(const db::Database& database, const IndexStamp& stamp,
                                   const Ids& former) {
  auto logged = database.embedding_changes(stamp.retriever_hash, stamp.generation);
  if (logged) return std::move(*logged);
  const Ids now = database.embedded_clips(stamp.retriever_hash);
  return {ids_without(now, former), ids_without(former, now)};
}

std::vector<float> new_vectors(const db::Database& database, const std::string& retriever_hash,
                               const Ids& ids, int width) {
  std::vector<float> vectors = database.motion_vectors(retriever_hash, ids, width);
  for (size_t i = 0; i < ids.size(); ++i) {
    require_unit_length(vectors.data() + i * static_cast<size_t>(width), width,
                        fmt::format("the vector of clip number {}", ids[i]));
  }
  return vectors;
}

template <typename Value>
void append_values(std::string& body, const std::vector<Value>& values) {
  body.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
}

template <typename Value>
void take_values(std::string_view& body, size_t count, std::vector<Value>& values) {
  values.resize(count);
  if (count > 0) std::memcpy(values.data(), body.data(), count * sizeof(Value));
  body.remove_prefix(count * sizeof(Value));
}

}  // namespace

std::vector<float> motion_vectors(const db::Database& database,
                                  const std::vector<db::ClipEmbedding>& embeddings, int width) {
  std::vector<float> vectors;
  vectors.reserve(embeddings.size() * static_cast<size_t>(width));
  for (const db::ClipEmbedding& embedding : embeddings) {
    const auto& motion = embedding.motion;
    if (motion.size() != static_cast<size_t>(width) || width == 0) {
      throw Error(
          fmt::format("{}: the vector of clip number {} has {} numbers instead of {}; "
                      "store the vectors of this retriever again",
                      database.path(), embedding.clip_id, motion.size(), width));
    }
    require_unit_length(motion.data(), width,
                        fmt::format("the vector of clip number {}", embedding.clip_id));
    vectors.insert(vectors.end(), motion.begin(), motion.end());
  }
  return vectors;
}

IndexStamp present_stamp(const db::Database& database, const std::string& retriever_hash) {
  const int64_t generation = database.generation();
  return {database.uuid(), generation, retriever_hash, database.writer_of(generation)};
}

void require_same_origin(const std::string& path, const IndexStamp& stamp,
                         const db::Database& database, const std::string& retriever_hash) {
  if (stamp.retriever_hash != retriever_hash) {
    throw Error(path + ": this index was built with another retriever (" + stamp.retriever_hash +
                " instead of " + retriever_hash + "); run: remomask index DB");
  }
  if (stamp.database_uuid != database.uuid()) {
    throw Error(path + ": this index does not belong to the database " + database.path() +
                "; run: remomask index DB");
  }
  // The caller's snapshot may be older than a file that was just written; the latest state counts.
  std::optional<db::Database> latest;
  if (stamp.generation > database.generation())
    latest.emplace(database.path(), db::OpenMode::read_only);
  const db::Database& reached = latest ? *latest : database;
  if (stamp.generation > reached.generation()) {
    throw Error(path + ": this index belongs to a later state of " + database.path() +
                " (is this an older copy?); run: remomask index DB");
  }
  if (stamp.writer != reached.writer_of(stamp.generation)) {
    throw Error(path + ": this index belongs to a copy of " + database.path() +
                " that was changed separately; run: remomask index DB");
  }
}

FollowedState follow_database(const db::Database& database, const Ids& base_ids, int width,
                              IndexStamp& stamp, IndexChanges& changes) {
  FollowedState result;
  Ids former = merged_ids(ids_without(base_ids, changes.dropped), changes.added);
  IndexStamp now = present_stamp(database, stamp.retriever_hash);
  if (now.generation == stamp.generation) {
    result.ids = std::move(former);
    return result;
  }
  const db::EmbeddingChanges changed = changed_clips(database, stamp, former);
  const Ids came = ids_without(changed.present, former);
  const Ids went = common_ids(changed.absent, former);
  const Ids missing = ids_without(came, base_ids);
  const auto vectors = new_vectors(database, stamp.retriever_hash, missing, width);
  replace_added(changes, merged_ids(ids_without(changes.added, went), missing), missing, vectors,
                width);
  changes.dropped = merged_ids(ids_without(changes.dropped, came), common_ids(went, base_ids));
  result.ids = merged_ids(ids_without(former, went), came);
  result.difference = {static_cast<int64_t>(came.size()), static_cast<int64_t>(went.size())};
  stamp = std::move(now);
  return result;
}

bool worth_folding(const IndexHeader& base, const IndexChanges& changes) {
  const double share = base.type.factory == "Flat" ? kFoldShareOfExact : kFoldShareOfApproximate;
  return static_cast<double>(changes.added.size() + changes.dropped.size()) >
         share * static_cast<double>(base.ids.size());
}

std::string delta_path(const std::string& path) { return path + ".delta"; }

void write_index_delta(const std::string& path, const IndexHeader& base, const IndexDelta& delta) {
  if (delta.changes.empty() && delta.stamp.generation == base.stamp.generation) {
    std::filesystem::remove(delta_path(path));
    return;
  }
  std::string body;
  body.reserve(sizeof(float) * delta.changes.vectors.size() +
               sizeof(int64_t) * (delta.changes.added.size() + delta.changes.dropped.size()) +
               kDescriptionRoom);
  append_values(body, delta.changes.added);
  append_values(body, delta.changes.dropped);
  append_values(body, delta.changes.vectors);
  const nlohmann::json description = {{"format", "remomask index delta"},
                                      {"base", base.checksum},
                                      {"database", delta.stamp.database_uuid},
                                      {"generation", delta.stamp.generation},
                                      {"retriever", delta.stamp.retriever_hash},
                                      {"added", delta.changes.added.size()},
                                      {"dropped", delta.changes.dropped.size()},
                                      {"width", base.width},
                                      {"writer", delta.stamp.writer},
                                      {"checksum", content_hash(body)}};
  body += describe(description, kDeltaMagic);
  // Does not wait for the disk, since the database's last commits do not, either.
  write_file_atomically(delta_path(path), body, Durability::kills);
}

std::optional<IndexDelta> read_index_delta(const std::string& path, const IndexHeader& base) {
  const std::string file = delta_path(path);
  if (!std::filesystem::exists(file)) return std::nullopt;
  const std::string content = read_file(file);
  try {
    const auto [whole, description] = split_described(file, content, kDeltaMagic, kUpdate);
    if (description.at("checksum").get<std::string>() != content_hash(whole)) {
      throw FileError(file, 0, std::string("the index is damaged; ") + kUpdate);
    }
    if (description.at("base").get<std::string>() != base.checksum) return std::nullopt;
    IndexDelta delta;
    delta.stamp = {description.at("database").get<std::string>(),
                   description.at("generation").get<int64_t>(),
                   description.at("retriever").get<std::string>(), description.value("writer", "")};
    const auto added = description.at("added").get<size_t>();
    const auto dropped = description.at("dropped").get<size_t>();
    // Each by itself first, since a sum of what a stranger claims can begin again at zero.
    const size_t most = whole.size() / sizeof(int64_t);
    const auto numbers = added * static_cast<size_t>(base.width);
    if (added > most || dropped > most ||
        whole.size() != (added + dropped) * sizeof(int64_t) + numbers * sizeof(float)) {
      throw FileError(file, 0, std::string("the index is damaged; ") + kUpdate);
    }
    std::string_view rest = whole;
    take_values(rest, added, delta.changes.added);
    take_values(rest, dropped, delta.changes.dropped);
    take_values(rest, numbers, delta.changes.vectors);
    return delta;
  } catch (const nlohmann::json::exception& error) {
    throw FileError(file, 0,
                    std::string("the index is damaged (") + error.what() + "); " + kUpdate);
  }
}

}  // namespace remomask::index
