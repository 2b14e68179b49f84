#pragma once

#include <string>
#include <vector>

#include "evaluation/ablation_exam.h"
#include "generator/model_training.h"

namespace remomask {

/// What an ablation trains on and asks about.
struct AblationClips {
  TrainingSplits training;          ///< `train` with mirror twins
  std::vector<TrainingClip> asked;  ///< of the split that prompts come from
};

/// Clips of the splits train, val and `asked` of these sources (empty: all), with
/// group numbers that agree between them. Throws FileError without training clips
/// or clips to ask about.
AblationClips load_ablation_clips(const Database& database, const std::string& asked,
                                  const std::vector<std::string>& sources);

/// The exam of `prompts` prompts from the captions of the asked clips, spread over
/// their contents (label_prompts.h). Keeps references to judge and clips.
AblationExam make_ablation_exam(const Evaluator& judge, const Database& database,
                                const AblationClips& clips, int prompts, uint64_t seed);

}  // namespace remomask
