#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "remomask/motion.h"
#include "remomask/progress.h"

namespace remomask::synthetic {

/// What can be chosen of one made motion. A kind uses only some of them and
/// the caption states only what was chosen.
struct ProceduralParameters {
  double speed = 0;               ///< m/s along the path; 0: the kind's usual speed
  double amplitude = 1;           ///< size of the movement, 0.5 .. 1.3
  int count = 1;                  ///< repetitions, 1 .. 6
  double duration = 4;            ///< seconds, 2 .. 9; kinds with a count derive their own
  std::string style = "neutral";  ///< "neutral", "energetic", "tired" or "old"
  bool from_stand = true;         ///< a steady gait starts and ends standing; else that is cut off
  uint64_t variation = 0;         ///< seed of the individual: arm carriage, noise, wording
};

/// A motion made by formula with captions that are true of it. Free of any
/// foreign licence.
struct ProceduralClip {
  std::string name;
  Motion motion;  ///< canonical: 22 joints, 20 fps, starts at the origin, faces +Z, floor at 0
  std::vector<std::string> captions;
  nlohmann::json labels;  ///< content, actions, source, parameters
  std::string split;      ///< "train", "val" or "test", from the name
};

struct ProceduralOptions {
  int count = 360;
  uint64_t seed = 1;
};

/// Every kind: "walk-forward", "wave-left", ...
const std::vector<std::string>& procedural_kinds();

/// One clip of `kind`; throws Error for an unknown kind or style, or a number
/// out of range.
ProceduralClip make_procedural_clip(const std::string& kind,
                                    const ProceduralParameters& parameters = {});

/// `count` clips that go through the kinds in turn, each with other parameters.
/// A function of the options alone. Throws Interrupted when the monitor asks to stop.
std::vector<ProceduralClip> make_procedural_clips(const ProceduralOptions& options = {},
                                                  const Monitor& monitor = {});

}  // namespace remomask::synthetic
