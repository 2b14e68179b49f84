#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lab/ablation_exam.h"
#include "lab/ablation_plan.h"

namespace remomask::lab {

/// One column of the ablation's tables.
struct AblationColumn {
  const char* title;
  const char* path;  ///< JSON pointer into ExamFigures
  double scale;      ///< of what is printed
  int digits;
};

const std::vector<AblationColumn>& ablation_columns();

/// The finite figures at `path` of one subset over the trials of a variant.
std::vector<double> seed_values(const nlohmann::json& variant, const std::string& subset,
                                const std::string& path);

/// Figures that stand alone (real clips, a point of a sweep) as a variant with one seed.
nlohmann::json one_seed(const nlohmann::json& figures);

/// Everything that a finished plan measured: settings, the figures of the real clips, "variants" in
/// the order of the options (name, meaning, weights, one entry per seed) and "sweeps" ("guidance",
/// "steps": value and figures). Throws FileError if a trial is missing or broken.
nlohmann::json ablation_document(const AblationOptions& options, const AblationPlan& plan,
                                 const ExamResult& real, const nlohmann::json& judge);

/// The document as Markdown tables: mean (minimum-maximum) over the seeds.
std::string ablation_markdown(const nlohmann::json& document);

}  // namespace remomask::lab
