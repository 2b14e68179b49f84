#include "evaluation/label_figures.h"

#include <algorithm>

namespace remomask::evaluation {

namespace {

/// Probability that at least one of `correct` entries is among the first k of
/// `entries` in random order; 0 < correct <= entries.
double chance_within(int64_t k, int64_t correct, int64_t entries) {
  double none = 1;
  for (int64_t i = 0; i < k && i < entries; ++i) {
    none *= std::max(0.0, static_cast<double>(entries - correct - i)) /
            static_cast<double>(entries - i);
  }
  return 1 - none;
}

}  // namespace

LabelFigures label_figures(const std::vector<LabelledQuery>& queries,
                           const std::vector<db::TrainingClip>& clips) {
  LabelFigures figures;
  for (const LabelledQuery& query : queries) {
    const db::TrainingClip &wanted = clips[query.clip], &found = clips[query.first];
    if (wanted.meaning.empty()) continue;
    ++figures.queries;
    if (found.content == wanted.content) ++figures.content;
    if (found.meaning == wanted.meaning) ++figures.meaning;
    for (size_t i = 0; i < kRecallRanks.size(); ++i) {
      figures.perfect_recall[i] +=
          chance_within(kRecallRanks[i], query.correct_of_them, query.same_meaning);
    }
  }
  const double to_percent = 100.0 / static_cast<double>(std::max<int64_t>(1, figures.queries));
  figures.content *= to_percent;
  figures.meaning *= to_percent;
  for (double& recall : figures.perfect_recall) recall *= to_percent;
  return figures;
}

}  // namespace remomask::evaluation
