#pragma once

#include <ATen/core/Tensor.h>

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace remomask::evaluation {

/// Captions as the evaluator's text encoder reads them.
struct WordBatch {
  at::Tensor ids;      ///< int64 [B, L]
  at::Tensor classes;  ///< int64 [B, L], WordClass
  at::Tensor lengths;  ///< int64 [B], words with sos and eos
};

/// Whole words of captions (normalised, letters only) as ids and classes.
class EvaluatorWords {
 public:
  static constexpr int64_t kStart = 0, kEnd = 1, kUnknown = 2;

  /// Throws Error unless the list starts with "sos", "eos", "unk" and has no
  /// word twice.
  EvaluatorWords(std::vector<std::string> vocabulary, int64_t max_words);

  /// sos, the first max_words words, eos; padded with unk / other to the longest.
  /// A word outside of the vocabulary is looked for by its base forms.
  WordBatch encode(const std::vector<std::string>& captions) const;

  int64_t size() const { return static_cast<int64_t>(ids_.size()); }

 private:
  int64_t id_of(const std::string& word) const;

  int64_t max_words_;
  std::unordered_map<std::string, int64_t> ids_;
};

/// "sos", "eos", "unk" and every word that occurs at least twice in the captions,
/// alphabetical.
std::vector<std::string> evaluator_vocabulary(const std::vector<std::string>& captions);

}  // namespace remomask::evaluation
