#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "db/training_set.h"
#include "motion/features.h"
#include "search/moments.h"

namespace remomask::evaluation {

/// A long motion made of clips, and the sentence that tells one of them.
struct MomentTask {
  motion::Features features;
  std::vector<search::MomentWindow> parts;  ///< where each clip lies
  std::vector<size_t> clips;                ///< that the parts are
  size_t asked = 0;                         ///< the part that the sentence tells
  std::string sentence;                     ///< first caption of its clip
};

struct MomentTaskOptions {
  int tasks = 300;
  int parts = 3;  ///< clips in each motion
  uint64_t seed = 0;
};

/// Draws tasks from one split: a function of clips and options alone.
class MomentTasks {
 public:
  /// Clips without caption or content are not drawn. Throws Error when there are
  /// fewer contents than parts.
  MomentTasks(const std::vector<db::TrainingClip>& clips, motion::FeatureMode mode,
              const MomentTaskOptions& options);

  size_t size() const { return static_cast<size_t>(options_.tasks); }
  /// Task number i: the asked clips go round through all clips in random order,
  /// the others are drawn at random; contents and groups of one task differ, and
  /// the place of the asked one is random. The clips' positions are joined by
  /// join_motions(), features are those of the joined positions.
  MomentTask task(size_t i) const;

 private:
  std::vector<db::TrainingClip> const& clips_;
  motion::FeatureMode mode_;
  MomentTaskOptions options_;
  std::vector<size_t> usable_, order_;
};

}  // namespace remomask::evaluation
