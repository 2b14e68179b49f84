#include "lab/ablation_clips.h"

#include <set>

#include "remomask/error.h"

namespace remomask::lab {

AblationClips load_ablation_clips(const db::Database& database, const std::string& asked,
                                  const std::vector<std::string>& sources) {
  db::TrainingSetOptions set;
  set.splits = {"train", "val", asked};
  set.sources = sources;
  AblationClips clips;
  int64_t last = -1;
  for (db::TrainingClip& clip : db::load_training_set(database, set)) {
    // A twin that was made here has the id of its original, which comes before it.
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

AblationExam make_ablation_exam(const evaluation::Evaluator& judge, const db::Database& database,
                                const AblationClips& clips, int prompts, uint64_t seed) {
  std::vector<const db::TrainingClip*> train, asked;
  for (const db::TrainingClip& clip : clips.training.train) {
    if (!clip.mirrored) train.push_back(&clip);
  }
  std::set<int64_t> known;
  for (const db::TrainingClip& clip : clips.asked) {
    asked.push_back(&clip);
    known.insert(clip.clip_id);
  }
  // Only clips that are long enough for the networks, and of the chosen sources.
  std::vector<db::Clip> candidates = database.clips();
  std::erase_if(candidates, [&](const db::Clip& clip) { return !known.contains(clip.id); });
  return {judge, train, asked,
          evaluation::choose_label_prompts(candidates, clips.asked.front().split, prompts, seed)};
}

}  // namespace remomask::lab
