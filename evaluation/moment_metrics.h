#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "evaluation/bootstrap.h"
#include "evaluation/moment_tasks.h"
#include "remomask/progress.h"
#include "search/moments.h"

namespace remomask::evaluation {

/// How well moments are found, in percent.
struct MomentFigures {
  double recall_50 = 0;  ///< intersection over union of the first moment at least 0.5
  double recall_70 = 0;  ///< at least 0.7
  double mean_iou = 0;
  std::vector<Interval> intervals;  ///< in this order; empty without a bootstrap
};

/// Figures of the intersection over union of each task's first moment; the
/// bootstrap draws tasks.
MomentFigures moment_figures(const std::vector<double>& overlaps,
                             const BootstrapOptions& bootstrap);

struct MomentEvaluation {
  MomentTaskOptions tasks;
  search::MomentOptions options;
  BootstrapOptions bootstrap;
  MomentFigures found;   ///< in the joined motions
  MomentFigures alone;   ///< in the asked clip by itself, all of which is right
  MomentFigures chance;  ///< in the joined motions, an answer of 1/parts of the frames anywhere
};

void to_json(nlohmann::json& json, const MomentEvaluation& evaluation);

/// Answers each task with the first moment of its sentence. Throws Interrupted
/// when stopped.
MomentEvaluation measure_moments(const retriever::Retriever& retriever,
                                 const std::vector<db::TrainingClip>& clips,
                                 const MomentTaskOptions& tasks,
                                 const search::MomentOptions& options = {},
                                 const BootstrapOptions& bootstrap = {},
                                 const Monitor& monitor = {});

}  // namespace remomask::evaluation
