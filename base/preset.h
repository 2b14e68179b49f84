#pragma once

#include <string>
#include <vector>

namespace remomask {

/// Sizes that a network can be built in.
enum class ModelSize {
  tiny,   ///< for tests: seconds to train
  small,  ///< for comparisons of many models
  base,   ///< the default: an hour to train on a few CPU cores
  paper,  ///< as published for ReMoMask
  momask  ///< as published for MoMask
};

/// A named value of the configurations of all networks: a size, and whether the model has MoMask's
/// design (one row for the whole body, no retrieval) with about as many weights.
struct Preset {
  ModelSize size = ModelSize::base;
  bool one_row = false;

  bool operator==(const Preset&) const = default;
};

/// All presets.
const std::vector<Preset>& all_presets();

/// "tiny", "base", "momask", "momask-base", ...
std::string preset_name(const Preset& preset);
std::string size_name(ModelSize size);

/// Reads what preset_name() writes. Throws Error that lists the names for any other one.
Preset parse_preset(const std::string& name);

/// The names of all presets.
std::vector<std::string> preset_names();

}  // namespace remomask
