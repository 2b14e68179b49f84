#pragma once

#include <ATen/core/Tensor.h>

#include <memory>
#include <string>
#include <vector>

#include "motion/features.h"
#include "nn/model_file.h"

namespace remomask::retriever {

struct TextEncoding {
  at::Tensor states;  ///< [B, S, text_width] token states of the text tower
  at::Tensor mask;    ///< [B, S] bool, true where a token exists
  at::Tensor query;   ///< [B, E] vector in the shared space, L2-normalised
  at::Tensor parts;   ///< [B, 6, P] what the words say about each part, each L2-normalised
};

struct MotionEncoding {
  at::Tensor global;  ///< [B, E] vector in the shared space, L2-normalised
  at::Tensor parts;   ///< [B, 6, P] part vectors, each L2-normalised
};

/// A trained retriever (text tower and six-part motion encoder) for inference.
/// Results of a text or clip do not depend on what it is batched with (1e-4).
/// Const functions may be called from several threads.
class Retriever {
 public:
  /// Throws Error when the stage is no retriever or its tensors do not fit.
  explicit Retriever(const nn::ModelStage& stage);
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

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace remomask::retriever
