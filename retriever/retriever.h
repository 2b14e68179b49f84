#pragma once

#include <ATen/core/Tensor.h>

#include <memory>
#include <string>
#include <vector>

#include "encoders/sentence_encoder.h"
#include "motion/features.h"
#include "nn/model_file.h"

namespace remomask::retriever {

struct TextEncoding {
  at::Tensor states;  ///< [B, S, text_width] of the word pieces, by the sentence encoder
  at::Tensor mask;    ///< [B, S] bool, true where a token exists
  at::Tensor query;   ///< [B, E] vector in the shared space, L2-normalised
  at::Tensor parts;   ///< [B, 6, P] what the words say about each part, each L2-normalised
};

struct MotionEncoding {
  at::Tensor global;  ///< [B, E] vector in the shared space, L2-normalised
  at::Tensor parts;   ///< [B, 6, P] part vectors, each L2-normalised
};

/// A trained retriever (text reader over a sentence encoder, six-part motion encoder) for
/// inference. Results of a text or clip do not depend on what it is batched with (1e-4). Const
/// functions may be called from several threads.
class Retriever {
 public:
  /// Throws Error when the stage is no retriever, its tensors do not fit, or it was trained over
  /// another sentence encoder.
  Retriever(const nn::ModelStage& stage, std::shared_ptr<const encoders::SentenceEncoder> words);
  ~Retriever();
  Retriever(Retriever&&) noexcept;
  Retriever& operator=(Retriever&&) noexcept;

  TextEncoding encode_text(const std::vector<std::string>& captions) const;
  /// Features in this model's mode, unnormalised; any lengths of at least 4 rows.
  MotionEncoding encode_motion(const std::vector<const motion::Features*>& clips) const;

  int64_t embedding_width() const;  ///< E
  int64_t part_width() const;       ///< P
  int64_t text_width() const;       ///< width of TextEncoding::states
  motion::FeatureMode feature_mode() const;
  const std::string& hash() const;  ///< stage_hash: identity in Database::embeddings
  const std::shared_ptr<const encoders::SentenceEncoder>& words() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The retriever of a model or stage file over the sentence encoder of a text file; empty: that
/// beside the model (text_file_of()). Throws FileError as nn::load_stage() and
/// SentenceEncoder::open() do.
Retriever open_retriever(const std::string& model_path, const std::string& text_path = "");
/// The same over a sentence encoder that is open already.
Retriever open_retriever(const std::string& model_path,
                         std::shared_ptr<const encoders::SentenceEncoder> words);

}  // namespace remomask::retriever
