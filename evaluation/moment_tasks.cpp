#include "evaluation/moment_tasks.h"

#include <set>

#include "base/random.h"
#include "evaluation/joined_motion.h"
#include "remomask/error.h"

namespace remomask::evaluation {

namespace {

constexpr uint64_t kTaskStream = 1;

}  // namespace

MomentTasks::MomentTasks(const std::vector<db::TrainingClip>& clips, motion::FeatureMode mode,
                         const MomentTaskOptions& options)
    : clips_(clips), mode_(mode), options_(options) {
  if (options.tasks < 1 || options.parts < 2) {
    throw Error("moments are measured on at least one motion of at least two clips");
  }
  std::set<std::string> contents;
  std::set<int> groups;
  for (size_t c = 0; c < clips.size(); ++c) {
    if (clips[c].captions.empty() || clips[c].content.empty()) continue;
    usable_.push_back(c);
    contents.insert(clips[c].content);
    groups.insert(clips[c].group);
  }
  const auto parts = static_cast<size_t>(options.parts);
  if (contents.size() < parts || groups.size() < parts) {
    throw Error("motions of " + std::to_string(parts) + " different contents need as many; the " +
                "clips have " + std::to_string(contents.size()) + " in captioned clips");
  }
  order_ = CounterRandom(options.seed).permutation(usable_.size());
}

MomentTask MomentTasks::task(size_t i) const {
  CounterRandom random(options_.seed, kTaskStream + i);
  MomentTask task;
  task.asked = random.below(static_cast<size_t>(options_.parts));
  const size_t asked_clip = usable_[order_[i % order_.size()]];
  std::set<std::string> contents = {clips_[asked_clip].content};
  std::set<int> groups = {clips_[asked_clip].group};
  std::vector<size_t> others;
  for (const size_t place : random.permutation(usable_.size())) {
    if (others.size() + 1 == static_cast<size_t>(options_.parts)) break;
    const db::TrainingClip& clip = clips_[usable_[place]];
    if (contents.contains(clip.content) || groups.contains(clip.group)) continue;
    contents.insert(clip.content);
    groups.insert(clip.group);
    others.push_back(usable_[place]);
  }
  if (others.size() + 1 < static_cast<size_t>(options_.parts)) {
    throw Error("clip '" + clips_[asked_clip].name +
                "' finds too few clips of other contents and groups to be joined with");
  }
  others.insert(others.begin() + static_cast<std::ptrdiff_t>(task.asked), asked_clip);
  task.clips = others;
  std::vector<Motion> motions;
  int first = 0;
  for (const size_t clip : task.clips) {
    motions.push_back(motion::recover_motion(clips_[clip].features, humanml_skeleton()));
    task.parts.push_back({first, first + motions.back().frames});
    first += motions.back().frames;
  }
  task.features = motion::extract_features_all_frames(join_motions(motions, humanml_skeleton()),
                                                      humanml_skeleton(), mode_);
  task.sentence = clips_[asked_clip].captions.front();
  return task;
}

}  // namespace remomask::evaluation
