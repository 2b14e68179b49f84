#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "motion/features.h"

namespace remomask::motion {

/// A feature mode in the configuration of a network, by its name.
inline void to_json(nlohmann::json& json, FeatureMode mode) { json = feature_mode_name(mode); }
inline void from_json(const nlohmann::json& json, FeatureMode& mode) {
  mode = parse_feature_mode(json.get<std::string>());
}

}  // namespace remomask::motion
