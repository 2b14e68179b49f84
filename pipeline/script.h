#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/motion_generator.h"
#include "remomask/progress.h"

namespace remomask::pipeline {

struct ScriptSegment {
  std::string sentence;
  std::vector<RetrievedMotion> hits;
  std::optional<double> seconds;  ///< default: see motion_frames()
};

/// Says how good a candidate of a segment is, more is better. `piece` is the segment
/// behind what was seen of the one before; its seam is before frame `seam`.
using JudgeSegment =
    std::function<double(const std::string& sentence, const Motion& piece, int seam)>;

struct ScriptOptions {
  GenerateOptions generate;  ///< of all segments; `seconds` is not read
  /// Token frames (0.2 s) at the end of a segment that are sampled once more with the next
  /// one, under its sentence: where one action becomes the other.
  int seam_tokens = 2;
  int candidates = 1;  ///< of each segment, of which `judge` chooses; more than one needs it
  JudgeSegment judge;
};

/// Frames [first, last) of the whole that belong to a segment.
struct MadeSegment {
  int first = 0, last = 0;
  uint64_t seed = 0;  ///< of the chosen candidate
  double score = 0;   ///< of it; 0 without candidates to choose from
  int hits_used = 0;
  std::optional<FollowedHit> followed;
};

struct ScriptMotion {
  Motion motion;      ///< uniform bone lengths, starts at the origin, not below the floor
  at::Tensor tokens;  ///< int64 [T, rows, levels]
  std::vector<MadeSegment> segments;
  GenerationTimes times;
};

/// Segments one after the other as one motion of any length: every segment is sampled
/// as the continuation of the tokens before it (kContextTokens of them are seen), and
/// the token map is decoded as a whole, so that poses and path have no seam to hide.
/// Frames are exact; a seam lies at the token boundary nearest to it. A function
/// of segments, options and model. Throws Error as Generator::generate() does, and
/// Interrupted when the monitor asks to stop.
ScriptMotion generate_script(const Generator& generator, const std::vector<ScriptSegment>& segments,
                             const ScriptOptions& options = {}, const Monitor& monitor = {});

}  // namespace remomask::pipeline
