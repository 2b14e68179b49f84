#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/evaluator_quality.h"
#include "evaluation/generation_metrics.h"
#include "evaluation/generation_run.h"
#include "evaluation/side_rule.h"

namespace remomask::evaluation {

/// All measures of one set of motions.
struct MotionFigures {
  ContentAccuracy content;     ///< the nearest real motion has the asked content
  GenerationFigures captions;  ///< batches with distinct captions
  GenerationFigures labels;    ///< batches with distinct captions, contents and styles
  SideCounts sides;            ///< prompts that name one side
  pipeline::PhysicalSummary physical;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MotionFigures, content, captions, labels, sides, physical)

/// A set of prompts.
struct GenerationSubset {
  std::string name;  ///< "all", "take", "pair" or "rare"
  int prompts = 0;
  double chance = 0;  ///< content accuracy of a gallery clip drawn at random
  MotionFigures generated;
  MotionFigures real;  ///< the prompts' own clips, which never find their own group
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(GenerationSubset, name, prompts, chance, generated, real)

struct LabelCount {
  int motions = 0, right = 0;
  std::map<std::string, int> nearest;  ///< content of the nearest clip -> how often
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LabelCount, motions, right, nearest)

struct GenerationReport {
  nlohmann::json protocol;
  std::vector<GenerationSubset> subsets;  ///< "all" first; empty ones are left out
  Figure multimodality;                   ///< no number when it was not measured
  std::map<std::string, LabelCount> contents;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(GenerationReport, protocol, subsets, multimodality, contents)

struct GenerationReportOptions {
  int draws = 20;
  int64_t batch = 32;
  int modality_picks = 10;
};

/// Figures of a finished run beside those of the prompts' own clips. Draw d uses
/// repeat d mod repeats.
GenerationReport report_generation(const GenerationRun& run, const db::Database& database,
                                   const JudgeGallery& gallery, const Evaluator& evaluator,
                                   const GenerationReportOptions& options = {});

}  // namespace remomask::evaluation
