#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/time.h"
#include "db/database.h"
#include "motion/features.h"

namespace remomask::db {

/// A clip as the networks see it.
struct TrainingClip {
  int64_t clip_id = 0;  ///< in the database; a mirror twin made here has the id of its original
  std::string name;     ///< "M" + name for a twin made here
  bool mirrored = false;
  std::string split;
  int group = 0;              ///< equal for clips that are the same motion (see Clip::group)
  motion::Features features;  ///< as many rows as the clip has frames (at most 200)
  std::vector<std::string> captions;  ///< mirrored for a twin
  std::string content;                ///< label "content" or first action; "" when unknown
  /// What the clip shows and how, labels "content" and "style"; "" when it has no
  /// label "content". Clips of one meaning are repetitions of one performance.
  std::string meaning;
  std::string unseen;  ///< "take", "pair" or "" (test clips of the data pack)
};

struct TrainingSetOptions {
  std::vector<std::string> splits = {"train"};
  std::vector<std::string> sources;  ///< data sets (Clip::source); empty: all
  motion::FeatureMode mode = motion::FeatureMode::fixed;
  bool add_mirrored = true;  ///< twins for clips whose mirror is not stored
  int min_frames = 20;
  int max_frames = kMaxClipFrames;  ///< longer clips are cut at the end
};

/// What the clip shows, in a word or phrase: its label "content", else its
/// first action; "" if it has neither.
std::string clip_content(const Clip& clip);

/// Loads clips and computes their features. Deterministic order (by id, twin
/// right after its original).
std::vector<TrainingClip> load_training_set(const Database& database,
                                            const TrainingSetOptions& options = {});

/// Hash of what a training sees of the clips: names, lengths, captions, meanings.
std::string training_set_identity(const std::vector<TrainingClip>& clips);

}  // namespace remomask::db
