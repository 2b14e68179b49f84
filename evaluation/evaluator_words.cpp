#include "evaluation/evaluator_words.h"

#include <torch/utils.h>

#include <algorithm>
#include <map>

#include "evaluation/word_classes.h"
#include "remomask/error.h"
#include "text/caption.h"
#include "text/words.h"

namespace remomask::evaluation {

namespace {

std::vector<std::string> letters_only_words(const std::string& caption) {
  std::vector<std::string> words = text::split_words(text::normalise_caption(caption));
  std::erase_if(words, [](const std::string& word) {
    return !std::all_of(word.begin(), word.end(), [](char c) { return c >= 'a' && c <= 'z'; });
  });
  return words;
}

}  // namespace

EvaluatorWords::EvaluatorWords(std::vector<std::string> vocabulary, int64_t max_words)
    : max_words_(max_words) {
  const std::vector<std::string> special = {"sos", "eos", "unk"};
  if (vocabulary.size() < special.size() ||
      !std::equal(special.begin(), special.end(), vocabulary.begin())) {
    throw Error("the evaluator's vocabulary does not start with sos, eos, unk");
  }
  for (const std::string& word : vocabulary) {
    if (!ids_.emplace(word, static_cast<int64_t>(ids_.size())).second) {
      throw Error("the evaluator's vocabulary has '" + word + "' twice");
    }
  }
}

int64_t EvaluatorWords::id_of(const std::string& word) const {
  for (const std::string& form : base_forms(word)) {
    if (const auto found = ids_.find(form); found != ids_.end()) return found->second;
  }
  return kUnknown;
}

WordBatch EvaluatorWords::encode(const std::vector<std::string>& captions) const {
  std::vector<std::vector<std::string>> all;
  size_t longest = 0;
  for (const std::string& caption : captions) {
    all.push_back(letters_only_words(caption));
    auto& words = all.back();
    words.resize(std::min(words.size(), static_cast<size_t>(max_words_)));
    longest = std::max(longest, words.size());
  }
  const auto rows = static_cast<int64_t>(captions.size());
  const auto columns = static_cast<int64_t>(longest) + 2;
  WordBatch batch{
      torch::full({rows, columns}, kUnknown, torch::kLong),
      torch::full({rows, columns}, static_cast<int64_t>(WordClass::other), torch::kLong),
      torch::zeros({rows}, torch::kLong)};
  for (int64_t row = 0; row < rows; ++row) {
    int64_t* ids = batch.ids.data_ptr<int64_t>() + row * columns;
    int64_t* classes = batch.classes.data_ptr<int64_t>() + row * columns;
    int64_t length = 0;
    ids[length++] = kStart;
    for (const std::string& word : all[static_cast<size_t>(row)]) {
      classes[length] = static_cast<int64_t>(word_class(word));
      ids[length++] = id_of(word);
    }
    ids[length++] = kEnd;
    batch.lengths.data_ptr<int64_t>()[row] = length;
  }
  return batch;
}

std::vector<std::string> evaluator_vocabulary(const std::vector<std::string>& captions) {
  std::map<std::string, int> counts;
  for (const std::string& caption : captions) {
    for (const std::string& word : letters_only_words(caption)) ++counts[word];
  }
  std::vector<std::string> vocabulary = {"sos", "eos", "unk"};
  for (const auto& [word, count] : counts) {
    const bool special =
        std::find(vocabulary.begin(), vocabulary.begin() + 3, word) != vocabulary.begin() + 3;
    if (count >= 2 && !special) vocabulary.push_back(word);
  }
  return vocabulary;
}

}  // namespace remomask::evaluation
