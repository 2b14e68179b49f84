#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "remomask/clip.h"
#include "remomask/motion.h"

namespace remomask::db {

/// A clip as the database stores it.
struct Clip : ClipInfo {
  nlohmann::json labels = nlohmann::json::object();
};

/// Captions that one clip can have.
constexpr int kCaptionsOfClip = 1024;

/// What to change of a clip; what is not given stays.
struct ClipChanges {
  std::optional<std::vector<std::string>> captions;
  std::optional<nlohmann::json> labels;  ///< JSON merge patch (RFC 7396): null removes a label
  std::optional<std::string> licence, split;
  std::optional<std::vector<std::string>> tags;
};

/// A clip whose captions answer a full-text query.
struct CaptionMatch {
  int64_t clip_id = 0;
  double bm25 = 0;  ///< of its best caption, as SQLite's FTS5 counts: lower is better
};

/// Vectors of one clip made by one retriever.
struct ClipEmbedding {
  int64_t clip_id = 0;
  std::vector<float> motion;  ///< global vector, L2-normalised
  std::vector<float> parts;   ///< six part vectors, concatenated
  std::vector<float> text;    ///< of the captions, mean, L2-normalised; the R_t of this clip
};

/// Clips of which vectors were stored or removed, ascending.
struct EmbeddingChanges {
  std::vector<int64_t> present;  ///< have vectors now
  std::vector<int64_t> absent;   ///< have none, or are gone
};

/// A caption, or another text, with the vector that a sentence encoder made of it.
struct CaptionVector {
  std::string text;
  std::vector<float> vector;  ///< L2-normalised
};

/// A caption that nobody wrote: the program took it from clips that move alike.
struct GuessedCaption {
  int64_t clip_id = 0;
  std::string text;
  double probability = 0;  ///< that it says what the clip shows
};

enum class OpenMode { read_only, read_write, create };

/// The motion database: one SQLite file (WAL), the truth of everything that is
/// searched. Not thread-safe: one object a thread.
class Database {
 public:
  /// Throws Error when the file is missing, locked, not a database, or made by
  /// a newer program. A database of an older version is upgraded when it is
  /// opened for writing; one of format 1 is refused when it is opened for reading.
  Database(const std::string& path, OpenMode mode);
  ~Database();
  Database(Database&&) noexcept;
  Database& operator=(Database&&) noexcept;

  const std::string& path() const;
  /// Identity of this database; a copy keeps it.
  std::string uuid() const;
  /// Grows with every change of clips or embeddings: an index knows its state.
  int64_t generation() const;
  /// Random token of the Database object that wrote this generation; empty when
  /// that was in format 2. With uuid and generation it names a state: copies
  /// that were changed apart reach the same generation by other writers.
  std::string writer_of(int64_t generation) const;

  // Clips.

  /// Stores a clip and its motion, returns its id. Throws Error for a name or
  /// content that is already there.
  int64_t add_clip(const Clip& clip, const Motion& motion);
  /// Removes all clips cut from one file, with their captions, motions and
  /// embeddings, and the note of its import; returns how many.
  int remove_clips(const std::string& source, const std::string& source_file);
  /// Returns whether that changed anything. Changed captions take the clip's
  /// embeddings of all retrievers with them. Throws Error for a clip that is not
  /// there and for values that add_clip() refuses.
  bool update_clip(int64_t id, const ClipChanges& changes);
  /// Removes these clips with all that belongs to them. The notes of imports
  /// stay: an import of the same files does not bring the clips back. Throws
  /// Error, and removes nothing, when one is not there.
  void remove(const std::vector<int64_t>& ids);
  std::optional<int64_t> find_name(const std::string& name) const;
  std::optional<int64_t> find_content(const std::string& content_hash) const;

  int64_t clip_count() const;
  /// Clips in the order of their ids, without motion.
  std::vector<Clip> clips() const;
  Clip clip(int64_t id) const;
  Motion motion(int64_t id) const;
  /// The clips whose captions answer a query in the language of SQLite's FTS5
  /// (words are compared by their stem, without case and accents), best first,
  /// then by id; negative `limit`: all. Throws Error for an invalid query.
  std::vector<CaptionMatch> match_captions(const std::string& fts_query, int limit = -1) const;

  /// Ids of the clips whose captions answer such a query, ascending, without their scores.
  std::vector<int64_t> clips_with_words(const std::string& fts_query) const;
  /// Whether a caption of this clip answers such a query.
  bool clip_has_words(int64_t clip_id, const std::string& fts_query) const;

  // The import log.

  /// Notes of one import, so that it can go on and be repeated: the fingerprint
  /// says which content of the file, imported how, is stored.
  bool file_is_imported(const std::string& source, const std::string& file,
                        const std::string& fingerprint) const;
  void note_imported_file(const std::string& source, const std::string& file,
                          const std::string& fingerprint, const std::string& outcome);
  /// File -> fingerprint of all notes of one source.
  std::map<std::string, std::string> imported_files(const std::string& source) const;

  // Embeddings.

  /// Replaces all vectors of `retriever_hash`.
  void store_embeddings(const std::string& retriever_hash,
                        const std::vector<ClipEmbedding>& embeddings);
  /// Stores vectors of some clips; those of others stay.
  void add_embeddings(const std::string& retriever_hash,
                      const std::vector<ClipEmbedding>& embeddings);
  /// By clip id.
  std::vector<ClipEmbedding> embeddings(const std::string& retriever_hash) const;
  /// Of these clips, in the order of `ids`. Throws Error when one has none.
  std::vector<ClipEmbedding> embeddings(const std::string& retriever_hash,
                                        const std::vector<int64_t>& ids) const;
  /// Ids, ascending, of the clips that this retriever has embedded; reads no vector.
  std::vector<int64_t> embedded_clips(const std::string& retriever_hash) const;
  /// Which vectors of this retriever have changed after that generation; costs no
  /// more than they. Nothing when the log of the changes does not reach so far
  /// back, as in a database of format 2.
  std::optional<EmbeddingChanges> embedding_changes(const std::string& retriever_hash,
                                                    int64_t generation) const;
  /// Motion vectors alone, [ids][width] in the order of `ids`. Throws Error when
  /// a clip has none or one of another width.
  std::vector<float> motion_vectors(const std::string& retriever_hash,
                                    const std::vector<int64_t>& ids, int width) const;
  /// Retrievers of which vectors are stored.
  std::vector<std::string> retrievers() const;
  /// Of one clip; nothing when this retriever has not embedded it.
  std::optional<ClipEmbedding> embedding(const std::string& retriever_hash, int64_t clip_id) const;

  // Vectors of captions, made by sentence encoders.

  /// Captions, each once and ascending, of which this encoder has no vector here.
  std::vector<std::string> captions_without_vector(const std::string& encoder_hash) const;
  /// Stores vectors; those of other texts stay.
  void add_caption_vectors(const std::string& encoder_hash,
                           const std::vector<CaptionVector>& vectors);
  /// Removes the vectors of this encoder whose captions no clip has any more, and those of other
  /// encoders; returns how many.
  int64_t drop_unused_caption_vectors(const std::string& encoder_hash);
  /// By text, ascending. Throws Error for a vector that is damaged.
  std::vector<CaptionVector> caption_vectors(const std::string& encoder_hash) const;
  /// Encoders of which vectors are stored.
  std::vector<std::string> caption_encoders() const;

  // Guessed captions. They are kept apart from those of people: Clip::captions, the full-text
  // index, training sets and exports do not know them.

  /// By clip, the most probable first.
  std::vector<GuessedCaption> guessed_captions() const;
  /// Stores further ones, those of one clip in falling order. Throws Error, and stores nothing, for
  /// a clip that has a caption of people.
  void store_guesses(const std::vector<GuessedCaption>& guesses);
  /// Returns how many of these clips had some. A caption of people removes those of its clip, too.
  int64_t remove_guesses(const std::vector<int64_t>& clip_ids);

  // Facts.

  /// Free-form facts about the whole database.
  void set_fact(const std::string& key, const std::string& value);
  std::optional<std::string> fact(const std::string& key) const;

 private:
  friend class ReadSnapshot;
  friend class Transaction;  // db/transaction.h
  void begin();
  void commit();
  void rollback();

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// While it lives, all reads of `database` see one state of it, whatever other
/// programs write meanwhile; writing through `database` is refused. Inside a
/// transaction, or another snapshot, it does nothing. `database` must outlive it.
class ReadSnapshot {
 public:
  explicit ReadSnapshot(const Database& database);
  ~ReadSnapshot();
  ReadSnapshot(const ReadSnapshot&) = delete;
  ReadSnapshot& operator=(const ReadSnapshot&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace remomask::db
