#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace remomask::db {

/// A word of a text as the full-text index reads it.
struct StemmedWord {
  std::string stem;           ///< without case and accents, "walk" of "Walking"
  size_t begin = 0, end = 0;  ///< bytes of the text
};

/// Reads texts as the index of the captions does: SQLite's own tokenizer (porter over unicode61).
/// Const functions may be called from several threads, which take turns.
class WordStems {
 public:
  WordStems();
  ~WordStems();
  WordStems(const WordStems&) = delete;
  WordStems& operator=(const WordStems&) = delete;

  std::vector<StemmedWord> read(std::string_view text) const;
  /// Of a single word; empty for a text without one.
  std::string stem(std::string_view word) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace remomask::db
