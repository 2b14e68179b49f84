#pragma once

#include <string>
#include <vector>

#include "lab/ablation_exam.h"
#include "training/model_training.h"

namespace remomask::lab {

/// The clips that an ablation trains on and asks about.
struct AblationClips {
  training::TrainingSplits training;    ///< `train` with mirror twins
  std::vector<db::TrainingClip> asked;  ///< of the split that prompts come from
};

/// Clips of the splits train, val and `asked` of these sources (empty: all), with group numbers
/// that agree between them. Throws FileError if there are no training clips or no clips to ask
/// about.
AblationClips load_ablation_clips(const db::Database& database, const std::string& asked,
                                  const std::vector<std::string>& sources);

/// The exam of `prompts` prompts from the captions of the asked clips, spread over their contents
/// (label_prompts.h). Keeps references to the judge and the clips.
AblationExam make_ablation_exam(const evaluation::Evaluator& judge, const db::Database& database,
                                const AblationClips& clips, int prompts, uint64_t seed);

}  // namespace remomask::lab
