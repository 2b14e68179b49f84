#include "search/word_index.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "search/compounds.h"
#include "search/coverage.h"
#include "search/lower_case.h"

namespace remomask::search {

namespace {

constexpr double kSaturation = 1.2, kLengthShare = 0.75;  // k1 and b of FTS5
constexpr double kLeastIdf = 1e-6;                        // for words in most texts, as FTS5 has it
constexpr double kClipsOfUnknown = 0.5;  // that a word which no clip has counts for
constexpr size_t kMostTerms = 64;        // of one query: a bit each

/// "s" of "person's", "t" of "don't".
bool is_ending(const std::string& word) {
  return word.size() == 1 && std::isalpha(static_cast<unsigned char>(word[0])) != 0;
}

}  // namespace

class WordIndex::Builder {
 public:
  explicit Builder(WordIndex& index) : index_(index) {}

  void add_clip(const std::vector<std::string>& texts) {
    std::vector<int32_t> terms;
    for (const std::string& text : texts) {
      const auto [place, is_new] = places_.emplace(text, static_cast<int32_t>(places_.size()));
      if (is_new) read(text);
      const auto number = static_cast<size_t>(place->second);
      ++times_[number];
      index_.texts_.push_back(place->second);
      for (size_t i = first_[number]; i < first_[number + 1]; ++i) terms.push_back(read_[i].first);
    }
    std::sort(terms.begin(), terms.end());
    terms.erase(std::unique(terms.begin(), terms.end()), terms.end());
    for (const int32_t term : terms) ++index_.terms_[static_cast<size_t>(term)].clips;
    index_.first_.push_back(index_.texts_.size());
  }

  void finish() {
    std::vector<Postings>& terms = index_.terms_;
    for (const auto& [term, count] : read_) ++terms[static_cast<size_t>(term)].last;
    size_t end = 0;
    for (Postings& one : terms) {
      one.first = end;
      end += one.last;
      one.last = one.first;
    }
    index_.postings_.resize(end);
    double words = 0, texts = 0;
    for (size_t text = 0; text < times_.size(); ++text) {
      for (size_t i = first_[text]; i < first_[text + 1]; ++i) {
        Postings& one = terms[static_cast<size_t>(read_[i].first)];
        index_.postings_[one.last++] = {static_cast<int32_t>(text), read_[i].second};
        one.texts += times_[text];
      }
      words += static_cast<double>(lengths_[text]) * times_[text];
      texts += times_[text];
    }
    index_.text_count_ = texts;
    const double mean = texts > 0 && words > 0 ? words / texts : 1;
    for (const int32_t length : lengths_) {
      index_.length_factor_.push_back(
          static_cast<float>(kSaturation * (1 - kLengthShare + kLengthShare * length / mean)));
    }
  }

 private:
  void read(const std::string& text) {
    const std::vector<db::StemmedWord> words = index_.stems_.read(text);
    std::vector<int32_t> numbers;
    for (const db::StemmedWord& word : words) {
      numbers.push_back(number_of(word.stem));
      ++index_.vocabulary_[lower_case(text.substr(word.begin, word.end - word.begin))];
    }
    for (const Compound& compound : find_compounds(text, words)) {
      if (compound.count > 1) numbers.push_back(number_of(compound.stem));
    }
    std::sort(numbers.begin(), numbers.end());
    for (size_t i = 0; i < numbers.size();) {
      size_t end = i;
      while (end < numbers.size() && numbers[end] == numbers[i]) ++end;
      read_.emplace_back(numbers[i], static_cast<int32_t>(end - i));
      i = end;
    }
    first_.push_back(read_.size());
    lengths_.push_back(static_cast<int32_t>(words.size()));
    times_.push_back(0);
  }

  int32_t number_of(const std::string& stem) {
    const auto [place, is_new] =
        index_.numbers_.emplace(stem, static_cast<int32_t>(index_.terms_.size()));
    if (is_new) index_.terms_.emplace_back();
    return place->second;
  }

  WordIndex& index_;
  std::unordered_map<std::string, int32_t> places_;
  std::vector<std::pair<int32_t, int32_t>> read_;  // term and count, by text
  std::vector<size_t> first_ = {0};                // of each text in read_
  std::vector<int32_t> lengths_, times_;
};

WordIndex::WordIndex(size_t clips,
                     const std::function<std::vector<std::string>(size_t)>& texts_of) {
  Builder builder(*this);
  first_.push_back(0);
  for (size_t place = 0; place < clips; ++place) builder.add_clip(texts_of(place));
  builder.finish();
}

const int32_t* WordIndex::find(const std::string& stem) const {
  const auto found = numbers_.find(stem);
  return found == numbers_.end() ? nullptr : &found->second;
}

std::vector<QueryTerm> WordIndex::terms(const std::string& sentence) const {
  const std::vector<db::StemmedWord> words = stems_.read(sentence);
  std::vector<QueryTerm> terms;
  const auto add = [&](const std::string& stem) {
    const bool known = std::any_of(terms.begin(), terms.end(),
                                   [&](const QueryTerm& term) { return term.stem == stem; });
    const int32_t* number = find(stem);
    if (!known) terms.push_back({stem, number ? *number : -1});
  };
  const std::vector<Compound> compounds = find_compounds(sentence, words);
  auto compound = compounds.begin();
  for (size_t i = 0; i < words.size(); ++i) {
    if (compound != compounds.end() && compound->first == i) {
      add(compound->stem);
      i += compound->count - 1;
      ++compound;
      continue;
    }
    const std::string word =
        lower_case(sentence.substr(words[i].begin, words[i].end - words[i].begin));
    if (!is_function_word(word) && !is_ending(word)) add(words[i].stem);
  }
  return terms;
}

double WordIndex::weight(const QueryTerm& term) const {
  const double with =
      term.number < 0 ? kClipsOfUnknown : terms_[static_cast<size_t>(term.number)].clips;
  return std::log1p(static_cast<double>(first_.size() - 1) / with);
}

WordMatches WordIndex::match(const std::vector<QueryTerm>& query) const {
  const size_t clips = first_.size() - 1;
  WordMatches matches{std::vector<float>(clips), std::vector<float>(clips)};
  std::vector<QueryTerm> terms = query;
  std::stable_sort(terms.begin(), terms.end(), [&](const QueryTerm& left, const QueryTerm& right) {
    return weight(left) > weight(right);
  });
  if (terms.size() > kMostTerms) terms.resize(kMostTerms);
  std::vector<float> scores(length_factor_.size());
  std::vector<uint64_t> present(length_factor_.size());
  double weights = 0;
  for (size_t i = 0; i < terms.size(); ++i) {
    weights += weight(terms[i]);
    if (terms[i].number < 0) continue;
    const Postings& one = terms_[static_cast<size_t>(terms[i].number)];
    const double idf =
        std::max(kLeastIdf, std::log((text_count_ - one.texts + 0.5) / (one.texts + 0.5)));
    for (size_t p = one.first; p < one.last; ++p) {
      const auto text = static_cast<size_t>(postings_[p].text);
      const auto count = static_cast<double>(postings_[p].count);
      scores[text] +=
          static_cast<float>(idf * count * (kSaturation + 1) / (count + length_factor_[text]));
      present[text] |= uint64_t{1} << i;
    }
  }
  float best = 0;
  for (size_t clip = 0; clip < clips; ++clip) {
    uint64_t words = 0;
    float& score = matches.bm25[clip];
    for (size_t i = first_[clip]; i < first_[clip + 1]; ++i) {
      const auto text = static_cast<size_t>(texts_[i]);
      words |= present[text];
      score = std::max(score, scores[text]);
    }
    best = std::max(best, score);
    double sum = 0;
    for (size_t i = 0; words != 0; ++i, words >>= 1) {
      if (words & 1) sum += weight(terms[i]);
    }
    if (sum > 0) matches.share[clip] = static_cast<float>(sum / weights);
  }
  if (best > 0) {
    for (float& score : matches.bm25) score /= best;
  }
  return matches;
}

bool WordIndex::clip_has(size_t place, const std::vector<QueryTerm>& terms) const {
  return std::all_of(terms.begin(), terms.end(), [&](const QueryTerm& term) {
    if (term.number < 0) return false;
    const Postings& one = terms_[static_cast<size_t>(term.number)];
    const auto begin = postings_.begin() + static_cast<std::ptrdiff_t>(one.first);
    const auto end = postings_.begin() + static_cast<std::ptrdiff_t>(one.last);
    for (size_t i = first_[place]; i < first_[place + 1]; ++i) {
      const auto found = std::lower_bound(
          begin, end, texts_[i],
          [](const Posting& posting, int32_t text) { return posting.text < text; });
      if (found != end && found->text == texts_[i]) return true;
    }
    return false;
  });
}

bool WordIndex::has_word(const std::string& word) const {
  const std::vector<db::StemmedWord> words = stems_.read(word);
  return !words.empty() && std::all_of(words.begin(), words.end(),
                                       [&](const auto& one) { return find(one.stem) != nullptr; });
}

std::vector<std::string> content_words(const std::string& text) {
  const auto is_letter = [](char c) {
    return static_cast<unsigned char>(c) >= 0x80 || std::isalnum(static_cast<unsigned char>(c));
  };
  std::vector<std::string> words;
  for (size_t i = 0; i < text.size();) {
    size_t end = i;
    const auto inside = [&](size_t at) {
      return (text[at] == '-' || text[at] == '\'') && at > i && at + 1 < text.size() &&
             is_letter(text[at + 1]);
    };
    while (end < text.size() && (is_letter(text[end]) || inside(end))) ++end;
    const std::string word = text.substr(i, end - i);
    i = end + (end == i ? 1 : 0);
    if (!word.empty() && !is_function_word(lower_case(word)) && !is_ending(word))
      words.push_back(word);
  }
  return words;
}

}  // namespace remomask::search
