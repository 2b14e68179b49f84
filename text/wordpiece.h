#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace remomask::text {

/// Token ids of one caption: [CLS] words [SEP].
struct TokenizedCaption {
  std::vector<int64_t> ids;
  int64_t dropped = 0;  ///< tokens beyond the limit, left out
  int64_t unknown = 0;  ///< [UNK] among `ids`
};

/// WordPiece: greedy longest match, "##" before a piece that continues a word.
/// A character that no piece covers becomes [UNK] alone, not its whole word.
class WordPiece {
 public:
  static constexpr int64_t kPad = 0, kUnknown = 1, kStart = 2, kEnd = 3, kMask = 4;
  static constexpr int64_t kSpecialTokens = 5;

  /// Throws Error unless the list starts with [PAD] [UNK] [CLS] [SEP] [MASK] and
  /// has no token twice.
  explicit WordPiece(std::vector<std::string> vocabulary);

  /// `caption` as normalise_caption() leaves it; at most `max_tokens` ids with
  /// [CLS] and [SEP].
  TokenizedCaption encode(const std::string& caption, int64_t max_tokens) const;
  /// Words of the ids with single spaces, special tokens left out.
  std::string decode(const std::vector<int64_t>& ids) const;

  int64_t size() const { return static_cast<int64_t>(vocabulary_.size()); }
  const std::vector<std::string>& vocabulary() const { return vocabulary_; }

 private:
  void encode_word(const std::string& word, std::vector<int64_t>& ids) const;

  std::vector<std::string> vocabulary_;
  std::unordered_map<std::string, int64_t> index_;
  size_t longest_ = 0;
};

/// Words and single punctuation characters of a normalised caption.
std::vector<std::string> split_words(const std::string& caption);

/// Learns a vocabulary of at most `size` tokens: the special tokens, every
/// character of the captions and of printable ASCII (alone and as
/// continuation), then merges. The next merge is the pair of neighbours that
/// raises the likelihood of the captions most, n(ab) log(n(ab) N / (n(a) n(b)))
/// (WordPiece, Schuster and Nakajima 2012), ties by alphabet, so that equal
/// captions in any order give the equal vocabulary. Captions normalised.
std::vector<std::string> train_wordpiece(const std::vector<std::string>& captions, int64_t size);

}  // namespace remomask::text
