#include "text/wordpiece.h"

#include <algorithm>
#include <array>

#include "remomask/error.h"
#include "text/utf8.h"

namespace remomask::text {

namespace {

constexpr std::array<const char*, WordPiece::kSpecialTokens> kSpecialNames = {
    "[PAD]", "[UNK]", "[CLS]", "[SEP]", "[MASK]"};

bool is_word_break(char c) {
  const auto u = static_cast<unsigned char>(c);
  return u < 0x80 && !(c >= 'a' && c <= 'z') && !(c >= '0' && c <= '9') && !(c >= 'A' && c <= 'Z');
}

size_t character_bytes(char first) {
  const auto u = static_cast<unsigned char>(first);
  return u < 0x80 ? 1 : u < 0xE0 ? 2 : u < 0xF0 ? 3 : 4;
}

}  // namespace

std::vector<std::string> split_words(const std::string& caption) {
  std::vector<std::string> words;
  std::string word;
  const auto finish = [&] {
    if (!word.empty()) words.push_back(word);
    word.clear();
  };
  for (const char c : caption) {
    if (is_word_break(c)) {
      finish();
      if (c != ' ') words.emplace_back(1, c);
    } else {
      word += c;
    }
  }
  finish();
  return words;
}

WordPiece::WordPiece(std::vector<std::string> vocabulary) : vocabulary_(std::move(vocabulary)) {
  for (int64_t i = 0; i < kSpecialTokens; ++i) {
    if (i >= size() || vocabulary_[i] != kSpecialNames[i]) {
      throw Error(
          "the vocabulary does not start with [PAD] [UNK] [CLS] [SEP] [MASK]; "
          "use a model file that this program made");
    }
  }
  for (int64_t i = 0; i < size(); ++i) {
    if (!index_.emplace(vocabulary_[i], i).second) {
      throw Error("the vocabulary has the token '" + vocabulary_[i] + "' twice");
    }
    longest_ = std::max(longest_, vocabulary_[i].size());
  }
}

void WordPiece::encode_word(const std::string& word, std::vector<int64_t>& ids) const {
  size_t start = 0;
  while (start < word.size()) {
    const std::string prefix = start == 0 ? "" : "##";
    size_t length = std::min(word.size() - start, longest_);
    int64_t found = kUnknown;
    for (; length > 0; --length) {
      const auto entry = index_.find(prefix + word.substr(start, length));
      if (entry != index_.end() && entry->second >= kSpecialTokens) {
        found = entry->second;
        break;
      }
    }
    ids.push_back(found);
    start += found == kUnknown ? character_bytes(word[start]) : length;
  }
}

TokenizedCaption WordPiece::encode(const std::string& caption, int64_t max_tokens) const {
  TokenizedCaption result;
  std::vector<int64_t> pieces;
  for (const std::string& word : split_words(caption)) encode_word(word, pieces);
  const int64_t room = std::max<int64_t>(0, max_tokens - 2);
  result.dropped = std::max<int64_t>(0, static_cast<int64_t>(pieces.size()) - room);
  pieces.resize(pieces.size() - static_cast<size_t>(result.dropped));
  result.unknown = std::count(pieces.begin(), pieces.end(), kUnknown);
  result.ids.push_back(kStart);
  result.ids.insert(result.ids.end(), pieces.begin(), pieces.end());
  result.ids.push_back(kEnd);
  return result;
}

std::string WordPiece::decode(const std::vector<int64_t>& ids) const {
  std::string text;
  for (const int64_t id : ids) {
    if (id < 0 || id >= size() || id == kPad || id == kStart || id == kEnd) continue;
    const std::string& token = vocabulary_[static_cast<size_t>(id)];
    if (token.size() > 2 && token.rfind("##", 0) == 0) {
      text += token.substr(2);
    } else {
      if (!text.empty()) text += ' ';
      text += token;
    }
  }
  return text;
}

}  // namespace remomask::text
