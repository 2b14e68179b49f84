#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "db/training_set.h"
#include "tools/evaluate_command.h"

namespace remomask::tools {

/// Clips of `split` of the input's sources, without mirror twins that are not stored. Throws
/// FileError if there are none.
std::vector<db::TrainingClip> load_clips(const EvaluationInput& input, const std::string& split,
                                         motion::FeatureMode mode);

/// The document of --json with what was measured: model, split, hash of its clips.
nlohmann::json stamped(const EvaluationInput& input, nlohmann::json document,
                       const std::vector<db::TrainingClip>& clips);

}  // namespace remomask::tools
