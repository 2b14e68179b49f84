#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "remomask/export.h"
#include "remomask/generation.h"
#include "remomask/progress.h"
#include "remomask/search.h"

namespace remomask {

struct OpenOptions {
  std::string index;  ///< index file; empty: beside the database
  /// File of the sentence encoder; empty: "text.safetensors" beside the model, else the shipped
  /// one.
  std::string text;
  int threads = 0;  ///< CPU threads of every call; 0: all that the process may use
  /// false: open no index, so that a database without one will do. Then nothing can be searched,
  /// retrieved or generated with retrieval.
  bool retrieval = true;
  bool low_memory = false;  ///< free the generator's networks after every call that used them
};

/// Text to motion: a model with the database that it retrieves from.
///
///     const remomask::TextToMotion remomask(model_file, database_file);
///     const remomask::GeneratedMotion made = remomask.generate("a person waves");
///     for (const remomask::Evidence& found : made.evidence) puts(found.hit.clip.name.c_str());
///     remomask::save_motion("wave.bvh", made);
///
/// Opening reads the database, its index and the model's retriever; the generator is loaded by the
/// first call that generates. Const functions may be called from
/// several threads. Every result is a function of model, database, query, options and seed: it
/// does not depend on the number of threads, on earlier calls or on calls beside it.
///
/// Every function throws Error (remomask/error.h) for what the caller can mend, and Interrupted
/// if `monitor.stop` is requested: it is checked at least once per pass of a network. Progress
/// is reported to `monitor.progress` on the calling thread.
class REMOMASK_API TextToMotion {
 public:
  /// Throws Error if a file is missing, damaged or of another kind, or if the database was not
  /// indexed with the model's retriever and the text file's encoder.
  TextToMotion(const std::string& model, const std::string& database,
               const OpenOptions& options = {});
  ~TextToMotion();
  TextToMotion(TextToMotion&&) noexcept;
  TextToMotion& operator=(TextToMotion&&) noexcept;

  /// A motion that shows the sentence, made with the motions that are retrieved for it. Throws
  /// Error for an empty sentence and for options out of range.
  GeneratedMotion generate(const std::string& sentence, const GenerateOptions& options = {},
                           const Monitor& monitor = {}) const;

  /// Generates spans of a motion again, and continues it. `original` has 22 joints at 20 fps and
  /// at least 4 frames; it may stand anywhere and have any size. Positions outside of the spans
  /// stay the same bit for bit. `seconds`, `length` and `influence` of the options are ignored:
  /// the length is the original's plus `extend_frames`. Throws Error for spans outside of the
  /// motion, for nothing to do, and for values that are not finite.
  EditedMotion edit(const Motion& original, std::span<const EditSpan> spans,
                    const std::string& sentence, const EditOptions& options = {},
                    const Monitor& monitor = {}) const;

  /// Several sentences as one motion of any length. `seconds` and `influence` of the options are
  /// ignored, `best_of` counts per sentence.
  ScriptedMotion script(std::span<const ScriptLine> lines, const GenerateOptions& options = {},
                        const Monitor& monitor = {}) const;

  /// The motions that generate() would read for a sentence, without generating.
  std::vector<Evidence> retrieve(const std::string& sentence,
                                 const GenerateOptions& options = {}) const;

  /// The clips that answer the query best. If `like_clip` is set, that clip is left out, and so
  /// is its group if hits are grouped. A clip with an unwanted word in a caption is left out,
  /// too. Exact, except that an approximate index answers queries without filter, words and
  /// body parts. Throws Error for a malformed query.
  SearchAnswer search(const SearchQuery& query) const;

  /// Hash of the model and all settings that matter, in one line (Provenance::generator).
  std::string identity(const GenerateOptions& options) const;

  /// The captions that describe a motion (`motion` or `like_clip` of the query, and its
  /// `filter`): those of the 50 clips with the most similar captions, the `k` best by their own
  /// cosine. Equal captions are listed once.
  std::vector<CaptionHit> captions_for(const SearchQuery& query) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace remomask
