#pragma once

#include <ATen/core/Tensor.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "db/training_set.h"
#include "evaluation/evaluator.h"
#include "evaluation/generation_metrics.h"
#include "evaluation/label_prompts.h"

namespace remomask::lab {

/// How well the motions of some prompts answer them.
struct ExamFigures {
  int prompts = 0;
  /// Share of the motions whose nearest training clip has the content of the prompt's clip.
  double content_right = 0;
  double foot_skate = 0;  ///< m/s, see PhysicalMetrics
  evaluation::GenerationFigures metrics;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ExamFigures, prompts, content_right, foot_skate, metrics)

/// Figures of all prompts ("all") and of some: "take" and "pair" (labels of what training has not
/// seen) and "rare" (contents with few training clips). Subsets without prompts are left out.
using ExamResult = std::map<std::string, ExamFigures>;

/// The same questions and the same judge for every model: an evaluator network
/// that no model was trained with.
class AblationExam {
 public:
  /// `train` without mirror twins is the gallery of contents; `asked` holds the clips of the
  /// prompts. Throws Error if a prompt's clip is missing.
  AblationExam(const evaluation::Evaluator& judge,
               const std::vector<const db::TrainingClip*>& train,
               const std::vector<const db::TrainingClip*>& asked,
               std::vector<evaluation::LabelPrompt> prompts);

  const std::vector<evaluation::LabelPrompt>& prompts() const { return prompts_; }
  /// TrainingClip::group of the prompts' clips.
  const std::vector<int>& groups() const { return groups_; }
  /// `motions` answer prompts() one by one; canonical, 22 joints.
  ExamResult grade(const std::vector<Motion>& motions) const;
  /// The figures of the prompts' own clips: what the judge makes of the truth.
  ExamResult grade_real() const;

 private:
  ExamResult figures(const at::Tensor& vectors, const std::vector<double>& foot_skate) const;

  const evaluation::Evaluator& judge_;
  std::vector<evaluation::LabelPrompt> prompts_;
  std::map<std::string, std::vector<bool>> subsets_;
  at::Tensor gallery_, text_, real_;  ///< [G, E], [P, E], [P, E]
  std::vector<std::string> gallery_contents_;
  std::vector<evaluation::BatchKeys> keys_;
  std::vector<int> groups_;
  int64_t batch_ = 0;  ///< of R-precision
};

}  // namespace remomask::lab
