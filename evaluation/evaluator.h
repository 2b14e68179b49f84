#pragma once

#include <memory>
#include <string>
#include <vector>

#include "evaluation/evaluator_config.h"
#include "nn/model_file.h"
#include "remomask/motion.h"

namespace remomask::evaluation {

/// The text-motion evaluator: captions and motions in one space that was
/// trained for measuring alone, with Euclidean distance. Shares no weights with
/// the retriever. Const functions may be called from several threads.
class Evaluator {
 public:
  /// Throws Error when the stage is no evaluator or its tensors do not fit.
  explicit Evaluator(const nn::ModelStage& stage);
  ~Evaluator();
  Evaluator(Evaluator&&) noexcept;
  Evaluator& operator=(Evaluator&&) noexcept;

  /// Float [N, E]. The vector of a caption does not depend on the others.
  at::Tensor embed_text(const std::vector<std::string>& captions) const;
  /// Unnormalised features in feature_mode() of at least 4 rows -> float [N, E];
  /// at most the first 196 rows are read, up to three at the end are left out.
  at::Tensor embed_motion(const std::vector<const motion::Features*>& motions) const;
  /// Any motion (22 joints, 20 fps): made canonical, features of all frames, as
  /// the clips of a database. Float [E]. Throws Error when a value is not finite.
  at::Tensor embed_motion(const Motion& motion) const;

  motion::FeatureMode feature_mode() const { return config().mode; }
  const EvaluatorConfig& config() const;
  const std::string& hash() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Reads a model file with the stage "evaluator", or a checkpoint in the names of
/// Guo et al. (see t2m_evaluator.h).
Evaluator load_evaluator(const std::string& path);

}  // namespace remomask::evaluation
