#pragma once

#include <string>
#include <vector>

#include "kinematics/splice.h"
#include "pipeline/motion_generator.h"

namespace remomask::pipeline {

/// Frames [first, last) of some body parts (order of body_parts(); none: all six).
struct CellSpan {
  int first = 0, last = 0;
  std::vector<int> parts;
};

struct Edited {
  Motion motion;               ///< where, and as large as, the original is
  motion::PartMask mask{0};    ///< what was made anew
  int64_t tokens = 0;          ///< cells of the token map ...
  int64_t tokens_sampled = 0;  ///< ... and how many of them were sampled
  int hits_used = 0;
  std::optional<FollowedHit> followed;
  kinematics::SpliceReport splice;
  GenerationTimes times;
};

/// Makes spans of a motion anew under a prompt, any set of frames and body parts, and
/// continues it. `original` holds 22 joints at 20 fps, at least 4 frames, Y up,
/// metres; it need be neither canonical nor of the uniform size. Positions outside of the
/// spans are those of `original` bit for bit; see splice_motion() for how the new
/// ones meet them. The motion is encoded as a whole; token cells of which any
/// frame is to change are sampled, the others are what the transformers see.
/// Throws Error for spans outside of the motion, nothing to do, a model of
/// another skeleton, or values that are not finite.
Edited edit_motion(const Generator& generator, const Motion& original,
                   const std::vector<CellSpan>& spans, const std::string& prompt,
                   const std::vector<RetrievedMotion>& hits, const EditOptions& options = {},
                   const Monitor& monitor = {});

}  // namespace remomask::pipeline
