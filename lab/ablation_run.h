#pragma once

#include <map>
#include <optional>
#include <string>

#include "lab/ablation_exam.h"
#include "lab/ablation_plan.h"
#include "training/model_training.h"

namespace remomask::lab {

/// Seconds that finished jobs took, and from them the seconds of the others: kept
/// in a file of the folder, so that a resumed run has its ETA at once.
class AblationClock {
 public:
  explicit AblationClock(std::string path);

  void note(const AblationJob& job, double seconds);
  /// Measured, or the job's operations at the speed of finished jobs of its kind
  /// (of any kind, where none is finished; 10^10 a second, where none is at all).
  double seconds(const AblationJob& job) const;

 private:
  std::string path_;
  nlohmann::json measured_ = nlohmann::json::object();  ///< file name -> kind, seconds, operations
};

/// Does what is not done of a plan, job after job. Every stage and every trial has
/// a file of its own; a run that was stopped or killed goes on at the job, and
/// inside a training at the checkpoint, where it was, to the same files. Progress
/// and ETA are of the whole plan. Throws Interrupted when asked to stop.
void run_ablation(const AblationPlan& plan, const training::TrainingSplits& clips,
                  const AblationExam& exam, AblationClock& clock, const Monitor& monitor);

/// Motions of a trained model for prompts. Hits come from the training clips: the
/// most similar ones to the prompt, one of a group, none of the prompt's own group
/// (`groups`, by the number of the prompt); `data` was made from `train`. Each motion is as long as
/// its prompt's clip.
std::vector<Motion> generate_answers(const AblationModel& model, const SamplingOptions& sampling,
                                     const std::vector<evaluation::LabelPrompt>& prompts,
                                     const std::vector<int>& groups,
                                     const training::GeneratorData& data,
                                     const std::vector<db::TrainingClip>& train,
                                     const Monitor& monitor);

}  // namespace remomask::lab
