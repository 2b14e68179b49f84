#pragma once

#include <string>
#include <vector>

#include "pipeline/motion_generator.h"

namespace remomask::pipeline {

/// What each of the hits that `made` used did to it: the share, 0 to 1, of its base tokens
/// that are others when this hit alone is left out, all else equal (leave-one-out).
/// `made` is what generate() gave for the same prompt, hits and options. Costs as many
/// generations as there are hits.
std::vector<double> hit_influence(const Generator& generator, const std::string& prompt,
                                  const std::vector<RetrievedMotion>& hits,
                                  const GenerateOptions& options, const Generated& made,
                                  const Monitor& monitor = {});

}  // namespace remomask::pipeline
