#include "text/bert_wordpiece.h"

#include <utf8proc.h>

#include <algorithm>

#include "base/bounded_file.h"
#include "remomask/error.h"
#include "text/encoding.h"
#include "text/utf8.h"

namespace remomask::text {

namespace {

constexpr int64_t kLongestWord = 100;  // characters
constexpr uint64_t kMostVocabularyBytes = 64u << 20;

/// A run of characters that is looked up as a whole.
struct TextToken {
  size_t begin = 0, end = 0;  // bytes of the text
  std::string normal;
  int64_t characters = 0;
  bool punctuation = false, joiner = false;
};

bool is_control_point(utf8proc_int32_t c) {
  if (c == '\t' || c == '\n' || c == '\r') return false;
  switch (utf8proc_category(c)) {
    case UTF8PROC_CATEGORY_CC:
    case UTF8PROC_CATEGORY_CF:
    case UTF8PROC_CATEGORY_CS:
    case UTF8PROC_CATEGORY_CO:
    case UTF8PROC_CATEGORY_CN:
      return true;
    default:
      return c == 0xFFFD;
  }
}

bool is_space_point(utf8proc_int32_t c) {
  if (c == ' ' || c == '\t' || c == '\n' || c == '\r') return true;
  const utf8proc_category_t category = utf8proc_category(c);
  return category == UTF8PROC_CATEGORY_ZS || category == UTF8PROC_CATEGORY_ZL ||
         category == UTF8PROC_CATEGORY_ZP;
}

/// Punctuation of Unicode, and every ASCII character that is neither letter, digit nor blank.
bool is_punctuation_point(utf8proc_int32_t c) {
  if (c < 0x80) {
    return (c >= 33 && c <= 47) || (c >= 58 && c <= 64) || (c >= 91 && c <= 96) ||
           (c >= 123 && c <= 126);
  }
  const utf8proc_category_t category = utf8proc_category(c);
  return category >= UTF8PROC_CATEGORY_PC && category <= UTF8PROC_CATEGORY_PO;
}

/// Characters that are written without blanks between words; not Hangul and Kana.
bool is_cjk_point(utf8proc_int32_t c) {
  constexpr utf8proc_int32_t kRanges[][2] = {
      {0x4E00, 0x9FFF},   {0x3400, 0x4DBF},   {0x20000, 0x2A6DF}, {0x2A700, 0x2B73F},
      {0x2B740, 0x2B81F}, {0x2B820, 0x2CEAF}, {0xF900, 0xFAFF},   {0x2F800, 0x2FA1F}};
  if (c < 0x3400) return false;
  return std::any_of(std::begin(kRanges), std::end(kRanges),
                     [&](const auto& range) { return c >= range[0] && c <= range[1]; });
}

/// Apostrophes and hyphens.
bool is_joiner_point(utf8proc_int32_t c) {
  return c == '\'' || c == '-' || c == 0x2019 || c == 0x2010 || c == 0x2011;
}

/// Splits a text into tokens, a character after the other.
class TokenSplitter {
 public:
  explicit TokenSplitter(const BertRules& rules) : rules_(rules) {}

  std::vector<TextToken> split(std::string_view text) {
    const auto* bytes = reinterpret_cast<const utf8proc_uint8_t*>(text.data());
    for (size_t at = 0; at < text.size();) {
      utf8proc_int32_t point = -1;
      const utf8proc_ssize_t length =
          utf8proc_iterate(bytes + at, static_cast<utf8proc_ssize_t>(text.size() - at), &point);
      const size_t end = at + (length > 0 ? static_cast<size_t>(length) : 1);
      if (length > 0 && point != 0 && !is_control_point(point)) add_point(point, at, end);
      at = end;
    }
    finish();
    return std::move(tokens_);
  }

 private:
  void add_point(utf8proc_int32_t point, size_t begin, size_t end) {
    if (is_space_point(point)) return finish();
    if (is_cjk_point(point)) finish();
    if (!rules_.strip_accents) {
      add_normal(point, begin, end);
    } else {
      utf8proc_int32_t parts[32];
      int bound_class = 0;
      const utf8proc_ssize_t count =
          utf8proc_decompose_char(point, parts, static_cast<utf8proc_ssize_t>(std::size(parts)),
                                  UTF8PROC_DECOMPOSE, &bound_class);
      for (utf8proc_ssize_t i = 0; i < count; ++i) {
        if (utf8proc_category(parts[i]) != UTF8PROC_CATEGORY_MN) add_normal(parts[i], begin, end);
      }
      if (!open_.normal.empty()) open_.end = end;  // an accent after its letter
    }
    if (is_cjk_point(point)) finish();
  }

  void add_normal(utf8proc_int32_t point, size_t begin, size_t end) {
    const bool punctuation = is_punctuation_point(point);
    if (punctuation) finish();
    if (open_.normal.empty()) open_.begin = begin;
    open_.end = end;
    append_utf8(open_.normal,
                static_cast<char32_t>(rules_.lower_case ? utf8proc_tolower(point) : point));
    ++open_.characters;
    if (!punctuation) return;
    open_.punctuation = true;
    open_.joiner = is_joiner_point(point);
    finish();
  }

  void finish() {
    if (!open_.normal.empty()) tokens_.push_back(std::move(open_));
    open_ = {};
  }

  BertRules rules_;
  TextToken open_;
  std::vector<TextToken> tokens_;
};

/// Whether token `i` is a joiner inside a word: "push-ups", "doesn't".
bool joins_words(const std::vector<TextToken>& tokens, size_t i) {
  if (!tokens[i].joiner || i == 0 || i + 1 == tokens.size()) return false;
  const TextToken &before = tokens[i - 1], &after = tokens[i + 1];
  return !before.punctuation && !after.punctuation && before.end == tokens[i].begin &&
         tokens[i].end == after.begin;
}

}  // namespace

BertWordPiece::BertWordPiece(std::vector<std::string> vocabulary, const BertRules& rules)
    : vocabulary_(std::move(vocabulary)), rules_(rules) {
  for (size_t i = 0; i < vocabulary_.size(); ++i) {
    const std::string& token = vocabulary_[i];
    if (!is_utf8(token)) {
      throw Error("the vocabulary's token " + std::to_string(i) + " is no UTF-8");
    }
    std::string_view piece = token;
    const bool continues = piece.size() > 2 && piece.starts_with("##");
    if (continues) piece.remove_prefix(2);
    if (!(continues ? continuations_ : starts_).emplace(piece, static_cast<int64_t>(i)).second) {
      throw Error("the vocabulary holds the token \"" + token + "\" twice");
    }
    longest_ = std::max(longest_, piece.size());
  }
  const auto special = [&](const char* name) {
    const auto found = starts_.find(name);
    if (found == starts_.end()) {
      throw Error(std::string("the vocabulary lacks the token ") + name +
                  "; it is no vocabulary of a BERT encoder");
    }
    return found->second;
  };
  pad_ = special("[PAD]");
  unknown_ = special("[UNK]");
  start_ = special("[CLS]");
  end_ = special("[SEP]");
  mask_ = special("[MASK]");
}

/// Whether the word has pieces; [UNK] otherwise.
bool BertWordPiece::append_pieces(std::string_view word, std::vector<int64_t>& ids) const {
  const size_t before = ids.size();
  for (size_t at = 0; at < word.size();) {
    const Pieces& pieces = at == 0 ? starts_ : continuations_;
    size_t length = std::min(word.size() - at, longest_);
    auto found = pieces.end();
    while (length > 0 && (found = pieces.find(word.substr(at, length))) == pieces.end()) --length;
    if (found == pieces.end()) {
      ids.resize(before);
      ids.push_back(unknown_);
      return false;
    }
    ids.push_back(found->second);
    at += length;
  }
  return true;
}

BertTokens BertWordPiece::encode(std::string_view text, int64_t max_tokens) const {
  const std::vector<TextToken> tokens = TokenSplitter(rules_).split(text);
  const auto room = static_cast<size_t>(std::max<int64_t>(0, max_tokens - 2));
  BertTokens result;
  result.ids.push_back(start_);
  for (size_t i = 0; i < tokens.size(); ++i) {
    const TextToken& token = tokens[i];
    const size_t first = result.ids.size();
    bool known = false;
    if (token.characters > kLongestWord) {
      result.ids.push_back(unknown_);
    } else {
      known = append_pieces(token.normal, result.ids);
    }
    const bool joins = joins_words(tokens, i);
    if (token.punctuation && !joins) continue;
    if (joins || (i > 0 && joins_words(tokens, i - 1))) {
      WordSpan& word = result.words.back();
      word.end = token.end;
      word.normal += token.normal;
      word.count = result.ids.size() - word.first;
      word.known = word.known && known;
    } else {
      result.words.push_back(
          {token.begin, token.end, token.normal, first, result.ids.size() - first, known});
    }
  }
  const size_t pieces = result.ids.size() - 1;
  if (pieces > room) {
    result.dropped = static_cast<int64_t>(pieces - room);
    result.ids.resize(1 + room);
    std::erase_if(result.words,
                  [&](const WordSpan& word) { return word.first + word.count > 1 + room; });
  }
  result.ids.push_back(end_);
  return result;
}

std::vector<std::string> read_bert_vocabulary(const std::string& path) {
  const std::string content = read_bounded_file(path, kMostVocabularyBytes);
  std::vector<std::string> lines;
  for (size_t begin = 0; begin < content.size();) {
    const size_t end = std::min(content.find('\n', begin), content.size());
    std::string line = content.substr(begin, end - begin);
    begin = end + 1;
    if (line.ends_with('\r')) line.pop_back();
    const auto number = static_cast<long>(lines.size() + 1);
    if (line.empty()) throw FileError(path, number, "is empty; every line holds one word piece");
    if (!is_utf8(line)) throw FileError(path, number, "is no UTF-8");
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace remomask::text
