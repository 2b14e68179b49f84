#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace remomask::lab {

/// Bars of every variant for content right, R@3 and FID: the mean over the seeds, a line from
/// minimum to maximum, and a dashed line for the real clips. `document`: see ablation_document().
void draw_ablation_bars(const std::string& png_path, const nlohmann::json& document);

/// The same figures against guidance and number of passes, one row for each sweep that was
/// measured. Draws nothing and returns false if there is none.
bool draw_ablation_sweeps(const std::string& png_path, const nlohmann::json& document);

}  // namespace remomask::lab
