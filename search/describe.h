#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "db/database.h"
#include "remomask/progress.h"

namespace remomask::search {

struct DescribeOptions {
  double min_probability = 0.3;
  size_t captions = 3;  ///< of one clip, at most
};

/// Captions for clips that have none, from clips that move alike.
struct Descriptions {
  std::vector<db::GuessedCaption> guesses;  ///< by clip, the most probable first
  int64_t undescribed = 0;                  ///< of the clips asked for: nothing was probable enough
  int64_t learnt_from = 0;                  ///< described clips that the probabilities come from
  double share_right = 0;                   ///< of the best guesses for these
};

/// For each clip the captions of the clips whose motion vectors are nearest, as far as these agree
/// with each other: a caption counts as much as the neighbours move alike and say alike. How often
/// such a caption is right at such a count is learnt from the described clips of the database
/// itself, each guessed from the others (clips of its own group left out): right is one whose clip
/// shares an action of the labels, or, without labels, whose vector has a cosine of 0.7 with a
/// caption of the clip. `clips` must be embedded and without captions. Throws Error when fewer than
/// 40 clips are described, and Interrupted.
Descriptions describe_clips(const db::Database& database, const std::string& retriever_hash,
                            const std::string& encoder_hash, const std::vector<int64_t>& clips,
                            const DescribeOptions& options, const Monitor& monitor = {});

}  // namespace remomask::search
