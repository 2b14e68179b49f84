#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "nn/model_file.h"

namespace remomask::training {

/// Loads the weights that a training goes on from into a fresh module, where names and shapes fit.
/// Returns what the trained stage says of it: the identity of the start, and the names of the
/// tensors that begin anew; empty without a start. Throws Error if nothing fits.
nlohmann::json start_from(torch::nn::Module& module, const std::optional<nn::ModelStage>& start);

}  // namespace remomask::training
