#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "motion/motion.h"

namespace remomask {

/// One motion of at most 200 frames. Long files become several clips that
/// overlap, with the same `source_file`.
struct Clip {
  int64_t id = 0;           ///< given by the database
  std::string name;         ///< unique, for example "01_01#2"
  std::string source;       ///< data set, for example "bandai2"
  std::string source_file;  ///< file stem it was cut from
  int start_frame = 0;      ///< of this window in the source at 20 fps
  std::string split;        ///< "train", "val", "test" or "none"
  std::string licence;
  std::string content_hash;  ///< of the canonical positions; unique
  std::string group;         ///< clips of one group are the same motion: windows of a
                             ///< file, mirror twins, the trial in another skeleton
  bool mirrored = false;     ///< a stored mirror copy (HumanML3D "M...")
  std::string skeleton = "humanml3d";
  int frames = 0;  ///< positions, 20 fps
  std::vector<std::string> captions;
  nlohmann::json labels = nlohmann::json::object();
};

/// Vectors of one clip made by one retriever.
struct ClipEmbedding {
  int64_t clip_id = 0;
  std::vector<float> motion;  ///< global vector, L2-normalised
  std::vector<float> parts;   ///< six part vectors, concatenated
  std::vector<float> text;    ///< of the captions, mean, L2-normalised; the R_t of this clip
};

enum class OpenMode { read_only, read_write, create };

/// The motion database: one SQLite file (WAL), the truth of everything that is
/// searched. Not thread-safe: one object a thread.
class Database {
 public:
  /// Throws Error when the file is missing, locked, not a database, or made by
  /// a newer program.
  Database(const std::string& path, OpenMode mode);
  ~Database();
  Database(Database&&) noexcept;
  Database& operator=(Database&&) noexcept;

  const std::string& path() const;
  /// Identity of this database; a copy keeps it.
  std::string uuid() const;
  /// Grows with every change of clips or embeddings: an index knows its state.
  int64_t generation() const;

  /// All statements between begin and commit are stored together or not at all.
  void begin();
  void commit();
  void rollback();

  /// Stores a clip and its motion, returns its id. Throws Error for a name or
  /// content that is already there.
  int64_t add_clip(const Clip& clip, const Motion& motion);
  /// Removes all clips cut from one file, with their captions, motions and
  /// embeddings, and the note of its import; returns how many.
  int remove_clips(const std::string& source, const std::string& source_file);
  std::optional<int64_t> find_name(const std::string& name) const;
  std::optional<int64_t> find_content(const std::string& content_hash) const;

  int64_t clip_count() const;
  /// Clips in the order of their ids, without motion.
  std::vector<Clip> clips() const;
  Clip clip(int64_t id) const;
  Motion motion(int64_t id) const;

  /// Notes of one import, so that it can go on and be repeated: the fingerprint
  /// says which content of the file, imported how, is stored.
  bool file_is_imported(const std::string& source, const std::string& file,
                        const std::string& fingerprint) const;
  void note_imported_file(const std::string& source, const std::string& file,
                          const std::string& fingerprint, const std::string& outcome);
  /// File -> fingerprint of all notes of one source.
  std::map<std::string, std::string> imported_files(const std::string& source) const;

  /// Replaces all vectors of `retriever_hash`.
  void store_embeddings(const std::string& retriever_hash,
                        const std::vector<ClipEmbedding>& embeddings);
  std::vector<ClipEmbedding> embeddings(const std::string& retriever_hash) const;
  /// Of one clip; nothing when this retriever has not embedded it.
  std::optional<ClipEmbedding> embedding(const std::string& retriever_hash, int64_t clip_id) const;

  /// Free-form facts about the whole database.
  void set_fact(const std::string& key, const std::string& value);
  std::optional<std::string> fact(const std::string& key) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace remomask
