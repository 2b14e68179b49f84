#include "evaluation/ablation_clips.h"

#include <set>

#include "base/error.h"

namespace remomask {

AblationClips load_ablation_clips(const Database& database, const std::string& asked,
                                  const std::vector<std::string>& sources) {
  TrainingSetOptions set;
  set.splits = {"train", "val", asked};
  set.sources = sources;
  AblationClips clips;
  int64_t last = -1;
  for (TrainingClip& clip : load_training_set(database, set)) {
    // A twin that was made here has the id of its original, which stands before it.
    const bool made_here = clip.clip_id == last;
    last = clip.clip_id;
    if (clip.split == "train") {
      clips.training.train.push_back(std::move(clip));
    } else if (!made_here) {
      (clip.split == asked ? clips.asked : clips.training.val).push_back(std::move(clip));
    }
  }
  if (asked == "val") clips.training.val = clips.asked;
  if (clips.training.train.empty() || clips.asked.empty()) {
    throw FileError(database.path(), 0, "needs clips of the splits train and " + asked);
  }
  return clips;
}

AblationExam make_ablation_exam(const Evaluator& judge, const Database& database,
                                const AblationClips& clips, int prompts, uint64_t seed) {
  std::vector<const TrainingClip*> train, asked;
  for (const TrainingClip& clip : clips.training.train) {
    if (!clip.mirrored) train.push_back(&clip);
  }
  std::set<int64_t> known;
  for (const TrainingClip& clip : clips.asked) {
    asked.push_back(&clip);
    known.insert(clip.clip_id);
  }
  // Only clips that are long enough for the networks, and of the chosen sources.
  std::vector<Clip> candidates = database.clips();
  std::erase_if(candidates, [&](const Clip& clip) { return !known.contains(clip.id); });
  return {judge, train, asked,
          choose_label_prompts(candidates, clips.asked.front().split, prompts, seed)};
}

}  // namespace remomask
