#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace remomask::text {

/// A word of a text and its pieces. Hyphens and apostrophes inside a word belong to it; other
/// punctuation is no word.
struct WordSpan {
  size_t begin = 0, end = 0;    ///< bytes of the text as typed
  std::string normal;           ///< as it is looked up: lower case, no accents
  size_t first = 0, count = 0;  ///< of BertTokens::ids
  bool known = true;            ///< no piece is [UNK]
};

struct BertTokens {
  std::vector<int64_t> ids;     ///< [CLS] pieces [SEP]
  int64_t dropped = 0;          ///< pieces beyond the limit, left out
  std::vector<WordSpan> words;  ///< those of which all pieces are there
};

/// What differs between the vocabularies of the BERT family.
struct BertRules {
  bool lower_case = true;
  bool strip_accents = true;
};

/// The tokenizer of BERT (Devlin et al. 2019): control characters dropped, CJK characters and
/// punctuation by themselves, then greedy longest match. A word without a match, or of more than
/// 100 characters, is [UNK]. Text cannot spell special tokens.
class BertWordPiece {
 public:
  /// `vocabulary` by id. Throws Error if [PAD], [UNK], [CLS], [SEP] or [MASK] is missing, or a
  /// token is there twice, or is no UTF-8.
  explicit BertWordPiece(std::vector<std::string> vocabulary, const BertRules& rules = {});
  BertWordPiece(const BertWordPiece&) = delete;  // the maps look into the vocabulary
  BertWordPiece& operator=(const BertWordPiece&) = delete;

  /// Any text; bytes that are no UTF-8 are left out. At most `max_tokens` ids, 2 or more.
  BertTokens encode(std::string_view text, int64_t max_tokens) const;

  /// Whether a word, in lower case, is one piece.
  bool has_word(std::string_view word) const { return starts_.contains(word); }

  int64_t pad_id() const { return pad_; }
  int64_t start_id() const { return start_; }
  int64_t end_id() const { return end_; }
  int64_t mask_id() const { return mask_; }
  int64_t unknown_id() const { return unknown_; }
  const std::vector<std::string>& vocabulary() const { return vocabulary_; }
  const BertRules& rules() const { return rules_; }

 private:
  using Pieces = std::unordered_map<std::string_view, int64_t>;
  bool append_pieces(std::string_view word, std::vector<int64_t>& ids) const;

  std::vector<std::string> vocabulary_;
  BertRules rules_;
  Pieces starts_, continuations_;
  size_t longest_ = 0;
  int64_t pad_ = 0, unknown_ = 0, start_ = 0, end_ = 0, mask_ = 0;
};

/// The lines of a vocabulary file (line number = id). Throws FileError for a line that is no UTF-8
/// or empty.
std::vector<std::string> read_bert_vocabulary(const std::string& path);

}  // namespace remomask::text
