#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "db/training_set.h"
#include "evaluation/recall.h"

namespace remomask::evaluation {

/// What the labels of the first hit say, in percent of the queries whose clip
/// has labels; ties go to the lower number.
struct LabelFigures {
  double content = 0;  ///< the asked content (TrainingClip::content)
  double meaning = 0;  ///< the asked content in the asked style (TrainingClip::meaning)
  int64_t queries = 0;
  /// Recall of a search that knows content and style of everything, and puts
  /// the repetitions of the asked ones first in random order: what captions that
  /// say no more than that allow.
  std::array<double, 5> perfect_recall{};
};

/// A query: its own clip, the clip found first, how many entries of the gallery
/// have its meaning and how many of them are correct.
struct LabelledQuery {
  size_t clip = 0, first = 0;
  int64_t same_meaning = 0, correct_of_them = 0;
};
LabelFigures label_figures(const std::vector<LabelledQuery>& queries,
                           const std::vector<db::TrainingClip>& clips);

}  // namespace remomask::evaluation
