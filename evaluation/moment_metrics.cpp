#include "evaluation/moment_metrics.h"

#include <algorithm>

#include "base/random.h"
#include "remomask/error.h"

namespace remomask::evaluation {

namespace {

constexpr uint64_t kChanceStream = 2;

/// The first moment of the query in the motion.
search::MomentWindow first_moment(const retriever::Retriever& retriever,
                                  const motion::Features& features, const at::Tensor& query,
                                  const search::MomentOptions& options) {
  const std::vector<search::MomentWindow> windows =
      search::moment_windows(features.frames, options);
  return search::best_moments(query, windows, search::encode_moments(retriever, features, windows),
                              1, options)
      .at(0)
      .window;
}

nlohmann::json moment_json(const MomentFigures& figures) {
  nlohmann::json json = {{"R@1 IoU 0.5", figures.recall_50},
                         {"R@1 IoU 0.7", figures.recall_70},
                         {"mean_iou", figures.mean_iou}};
  if (figures.intervals.empty()) return json;
  const char* const names[] = {"R@1 IoU 0.5", "R@1 IoU 0.7", "mean_iou"};
  for (size_t i = 0; i < figures.intervals.size(); ++i) {
    json["intervals"][names[i]] = {figures.intervals[i].low, figures.intervals[i].high};
  }
  return json;
}

}  // namespace

MomentFigures moment_figures(const std::vector<double>& overlaps,
                             const BootstrapOptions& bootstrap) {
  MomentFigures figures;
  if (overlaps.empty()) return figures;
  const auto statistic = [&](const std::vector<size_t>& sample) {
    std::vector<double> sums(3);
    for (const size_t i : sample) {
      sums[0] += overlaps[i] >= 0.5 ? 100 : 0;
      sums[1] += overlaps[i] >= 0.7 ? 100 : 0;
      sums[2] += 100 * overlaps[i];
    }
    for (double& sum : sums) sum /= static_cast<double>(sample.size());
    return sums;
  };
  std::vector<size_t> every(overlaps.size());
  for (size_t i = 0; i < every.size(); ++i) every[i] = i;
  const std::vector<double> values = statistic(every);
  figures.recall_50 = values[0];
  figures.recall_70 = values[1];
  figures.mean_iou = values[2];
  figures.intervals = bootstrap_intervals({overlaps.size()}, statistic, bootstrap);
  return figures;
}

void to_json(nlohmann::json& json, const MomentEvaluation& evaluation) {
  json = {{"tasks", evaluation.tasks.tasks},         {"parts", evaluation.tasks.parts},
          {"seed", evaluation.tasks.seed},           {"windows", evaluation.options.lengths},
          {"stride", evaluation.options.stride},     {"margin", evaluation.options.margin},
          {"share", evaluation.options.share},       {"resamples", evaluation.bootstrap.resamples},
          {"found", moment_json(evaluation.found)},  {"alone", moment_json(evaluation.alone)},
          {"chance", moment_json(evaluation.chance)}};
}

MomentEvaluation measure_moments(const retriever::Retriever& retriever,
                                 const std::vector<db::TrainingClip>& clips,
                                 const MomentTaskOptions& tasks,
                                 const search::MomentOptions& options,
                                 const BootstrapOptions& bootstrap, const Monitor& monitor) {
  const MomentTasks all(clips, retriever.feature_mode(), tasks);
  CounterRandom random(tasks.seed, mix_seed(tasks.seed, kChanceStream));
  std::vector<double> found, alone, chance;
  for (size_t i = 0; i < all.size(); ++i) {
    if (monitor.stop_requested()) throw Interrupted("the evaluation of moments was stopped");
    const MomentTask task = all.task(i);
    const search::MomentWindow& right = task.parts[task.asked];
    const at::Tensor query = retriever.encode_text({task.sentence}).query[0];
    found.push_back(
        search::temporal_iou(first_moment(retriever, task.features, query, options), right));
    const motion::Features& clip = clips[task.clips[task.asked]].features;
    alone.push_back(
        search::temporal_iou(first_moment(retriever, clip, query, options), {0, clip.frames}));
    const int length = std::max(1, task.features.frames / tasks.parts);
    const auto first =
        static_cast<int>(random.below(static_cast<size_t>(task.features.frames - length) + 1));
    chance.push_back(search::temporal_iou({first, first + length}, right));
    monitor.report(
        {"evaluate moments", static_cast<double>(i + 1), static_cast<double>(all.size()), ""});
  }
  return {tasks,
          options,
          bootstrap,
          moment_figures(found, bootstrap),
          moment_figures(alone, bootstrap),
          moment_figures(chance, bootstrap)};
}

}  // namespace remomask::evaluation
