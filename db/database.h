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

/// Changes to a clip; members that are not set stay as they are.
struct ClipChanges {
  std::optional<std::vector<std::string>> captions;
  std::optional<nlohmann::json> labels;  ///< JSON merge patch (RFC 7396): null removes a label
  std::optional<std::string> licence, split;
  std::optional<std::vector<std::string>> tags;
};

/// A clip whose captions match a full-text query.
struct CaptionMatch {
  int64_t clip_id = 0;
  double bm25 = 0;  ///< of its best caption, as SQLite's FTS5 computes it: lower is better
};

/// Vectors of one clip made by one retriever.
struct ClipEmbedding {
  int64_t clip_id = 0;
  std::vector<float> motion;  ///< global vector, L2-normalised
  std::vector<float> parts;   ///< six part vectors, concatenated
  std::vector<float> text;    ///< mean over the captions, L2-normalised; the R_t of this clip
};

/// Clips whose vectors were stored or removed, ascending.
struct EmbeddingChanges {
  std::vector<int64_t> present;  ///< have vectors now
  std::vector<int64_t> absent;   ///< have none, or were removed
};

/// A caption, or another text, with its vector from a sentence encoder.
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

/// The motion database: one SQLite file (WAL), the source of truth for everything that is
/// searched. Not thread-safe: use one object per thread.
class Database {
 public:
  /// Throws Error if the file is missing, locked, not a database, or written by
  /// a newer program. A database of an older version is upgraded when it is
  /// opened for writing; one of format 1 is refused when it is opened for reading.
  Database(const std::string& path, OpenMode mode);
  ~Database();
  Database(Database&&) noexcept;
  Database& operator=(Database&&) noexcept;

  const std::string& path() const;
  /// Identity of this database; a copy keeps it.
  std::string uuid() const;
  /// Increases with every change of clips or embeddings; an index records it.
  int64_t generation() const;
  /// Random token of the Database object that wrote this generation; empty for
  /// format 2. Together with UUID and generation it identifies a state: copies
  /// that were changed separately reach the same generation with different writers.
  std::string writer_of(int64_t generation) const;

  // Clips.

  /// Stores a clip and its motion and returns its id. Throws Error for a name or
  /// a content hash that is already stored.
  int64_t add_clip(const Clip& clip, const Motion& motion);
  /// Removes all clips cut from one file, with their captions, motions and
  /// embeddings, and the note of its import; returns their number.
  int remove_clips(const std::string& source, const std::string& source_file);
  /// Returns whether anything changed. A change of the captions removes the clip's
  /// embeddings of all retrievers. Throws Error for an unknown
  /// clip and for values that add_clip() refuses.
  bool update_clip(int64_t id, const ClipChanges& changes);
  /// Removes these clips with all that belongs to them. The import notes
  /// stay: importing the same files does not bring the clips back. Throws
  /// Error, and removes nothing, if one of them is unknown.
  void remove(const std::vector<int64_t>& ids);
  std::optional<int64_t> find_name(const std::string& name) const;
  std::optional<int64_t> find_content(const std::string& content_hash) const;

  int64_t clip_count() const;
  /// Clips in the order of their ids, without motion.
  std::vector<Clip> clips() const;
  Clip clip(int64_t id) const;
  Motion motion(int64_t id) const;
  /// The clips whose captions match a query in the syntax of SQLite's FTS5
  /// (words are compared by their stem, ignoring case and accents), best first,
  /// then by id; negative `limit`: all. Throws Error for an invalid query.
  std::vector<CaptionMatch> match_captions(const std::string& fts_query, int limit = -1) const;

  /// Ids of the clips whose captions match such a query, ascending, without their scores.
  std::vector<int64_t> clips_with_words(const std::string& fts_query) const;
  /// Whether a caption of this clip matches such a query.
  bool clip_has_words(int64_t clip_id, const std::string& fts_query) const;

  // The import log.

  /// Notes about imported files, so that an import can be resumed and repeated: the fingerprint
  /// identifies the content of a file and the options that it was imported with.
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
  /// Stores vectors of some clips; those of other clips stay.
  void add_embeddings(const std::string& retriever_hash,
                      const std::vector<ClipEmbedding>& embeddings);
  /// In the order of the clip ids.
  std::vector<ClipEmbedding> embeddings(const std::string& retriever_hash) const;
  /// Of these clips, in the order of `ids`. Throws Error if one of them has none.
  std::vector<ClipEmbedding> embeddings(const std::string& retriever_hash,
                                        const std::vector<int64_t>& ids) const;
  /// Ids, ascending, of the clips that this retriever has embedded; reads no vector.
  std::vector<int64_t> embedded_clips(const std::string& retriever_hash) const;
  /// Which vectors of this retriever have changed after that generation; the cost is proportional
  /// to their number. Nothing if the log of the changes does not reach back
  /// that far, as in a database of format 2.
  std::optional<EmbeddingChanges> embedding_changes(const std::string& retriever_hash,
                                                    int64_t generation) const;
  /// Motion vectors alone, [ids][width] in the order of `ids`. Throws Error if
  /// a clip has none or one of another width.
  std::vector<float> motion_vectors(const std::string& retriever_hash,
                                    const std::vector<int64_t>& ids, int width) const;
  /// Hashes of the retrievers whose vectors are stored.
  std::vector<std::string> retrievers() const;
  /// Of one clip; nothing if this retriever has not embedded it.
  std::optional<ClipEmbedding> embedding(const std::string& retriever_hash, int64_t clip_id) const;

  // Vectors of captions, made by sentence encoders.

  /// The captions without a vector of this encoder, each once, ascending.
  std::vector<std::string> captions_without_vector(const std::string& encoder_hash) const;
  /// Stores vectors; those of other texts stay.
  void add_caption_vectors(const std::string& encoder_hash,
                           const std::vector<CaptionVector>& vectors);
  /// Removes the vectors of this encoder whose captions no clip has any more, and all vectors of
  /// other encoders; returns their number.
  int64_t drop_unused_caption_vectors(const std::string& encoder_hash);
  /// In ascending order of the texts. Throws Error for a damaged vector.
  std::vector<CaptionVector> caption_vectors(const std::string& encoder_hash) const;
  /// Hashes of the encoders whose vectors are stored.
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

/// During its lifetime all reads of `database` see the same state, even if other
/// programs write to it; writing through `database` is refused. Inside a
/// transaction or another snapshot it does nothing. `database` must outlive it.
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
