#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace remomask::nn {
struct ModelStage;
}

namespace remomask::encoders {

class TextTower;

/// A word of a text, read in its sentence.
struct WordState {
  std::string typed;         ///< as in the text, "Push-ups"
  std::string normal;        ///< as the encoder reads it: lower case, no accents, "push-ups"
  bool known = true;         ///< false: the encoder has no pieces for it, or for a part of it
  std::vector<float> state;  ///< width() values, unit length
};

/// Kind of the stage that a text file holds.
inline constexpr const char* kTextEncoderStage = "text-encoder";

/// A pretrained sentence encoder for inference: texts and words to vectors whose dot product is
/// their likeness in meaning (1 is equal). What a text gives does not depend on what it is batched
/// with (1e-5). Const functions may be called from several threads.
class SentenceEncoder {
 public:
  /// Reads a text file: its encoder, and its adapter if it has one. Throws FileError when the file
  /// holds no text encoder, is damaged, or holds an adapter of another encoder.
  static SentenceEncoder open(const std::string& path);
  /// The same for the stages of a text file that was read from `origin`.
  static SentenceEncoder of_stages(const std::map<std::string, nn::ModelStage>& stages,
                                   const std::string& origin);
  ~SentenceEncoder();
  SentenceEncoder(SentenceEncoder&&) noexcept;
  SentenceEncoder& operator=(SentenceEncoder&&) noexcept;

  /// A vector of unit length for each text, in their order, with the adapter. Any text has one, an
  /// empty one too; what is longer than max_tokens() word pieces is cut there.
  std::vector<std::vector<float>> embed(const std::vector<std::string>& texts) const;

  /// The words of a text with their states in the last layer, without the adapter: mean over the
  /// pieces of a word. Punctuation is no word, but hyphens and apostrophes inside a word belong to
  /// it. Words beyond max_tokens() are left out.
  std::vector<WordState> words(const std::string& text) const;
  /// The same for each of many texts.
  std::vector<std::vector<WordState>> words(const std::vector<std::string>& texts) const;

  /// Whether a word, in lower case, is one piece of the vocabulary: of a large vocabulary, that it
  /// is a word of its language.
  bool is_word(const std::string& word) const;

  int64_t width() const;
  int64_t max_tokens() const;
  bool has_adapter() const;
  /// Identity of weights, config and adapter, like Retriever::hash(): vectors of encoders of
  /// different hashes must not be compared.
  const std::string& hash() const;

  /// The encoder without its adapter: what retriever and generator read the states of words of.
  /// Shared and constant; nobody trains it.
  std::shared_ptr<TextTower> tower() const;
  /// Identity of the weights and the config of tower().
  const std::string& tower_hash() const;

 private:
  struct Impl;
  explicit SentenceEncoder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace remomask::encoders
