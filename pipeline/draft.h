#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "remomask/motion.h"

namespace remomask::pipeline {

// A retrieved motion as the start of a token map: some of its token frames stay, the
// masked transformer makes the others under the prompt.

/// What is known of a hit before its codes are asked for.
struct DraftCandidate {
  double similarity = 0;
  int frames = 0;
};

/// The candidate to follow in a motion of `frames` frames. Candidates are scored by
/// similarity x exp(-0.1 |l - l'| / max(l, l')) (the length term of ReMoDiffuse);
/// of those within 0.03 of the best one is drawn by the seed, so that several seeds
/// follow several motions. Nothing for no candidate of at least 8 frames.
std::optional<size_t> choose_draft(const std::vector<DraftCandidate>& candidates, int frames,
                                   uint64_t seed);

/// A motion at most `frames` frames long: resampled in time where the lengths differ by
/// at most a quarter; of a longer one the stretch of `frames` frames in which the joints
/// travel furthest.
Motion fit_length(const Motion& motion, int frames);

/// Which of `frames` token frames keep the codes of the draft: round(share x frames) of
/// them, spread evenly (the multiples of the golden ratio, from a start drawn by the
/// seed). A smaller share keeps a subset.
std::vector<bool> followed_frames(int64_t frames, double share, uint64_t seed);

}  // namespace remomask::pipeline
