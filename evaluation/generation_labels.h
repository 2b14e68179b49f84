#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/progress.h"
#include "db/database.h"
#include "evaluation/label_prompts.h"
#include "evaluation/physical.h"
#include "index/vector_index.h"

namespace remomask {

// The content-label protocol: does a generated motion show what its prompt
// asks for? The generated motion is embedded like a real one; it counts as
// right when the nearest real motion has the content label of the clip that
// the prompt was written for.

/// Generates a canonical motion (22 joints, 20 fps) from prompt.text with prompt.seed.
using GenerateMotion = std::function<Motion(const LabelPrompt& prompt)>;
/// Vector of a motion in the space of the gallery; see embed_motion().
using EmbedMotion = std::function<std::vector<float>(const Motion& motion)>;

struct GenerationLabelOptions {
  int prompts = 200;
  uint64_t seed = 1;
  std::string prompt_split = "test";
  std::vector<std::string> gallery_splits = {"train", "val", "test"};
  /// Leave the clips of the prompt's own group out of the gallery: for the
  /// reference figure, where the "generated" motion is the real clip itself.
  bool exclude_own_group = false;
  std::string generator;     ///< identity of the generator (hash, settings), for the stamp
  std::string results_path;  ///< JSON lines, one a prompt; an existing file is continued
};

/// What became of one prompt: a line of the results.
struct LabelOutcome {
  int number = 0;  ///< of the prompt, from 0
  std::string clip, text, content;
  uint64_t seed = 0;
  std::string nearest_clip, nearest_content;  ///< "" when the motion was not finite
  double similarity = 0;
  bool right = false;
  PhysicalMetrics physical;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LabelOutcome, number, clip, text, content, seed, nearest_clip,
                                   nearest_content, similarity, right, physical)

struct LabelCount {
  int prompts = 0;
  int right = 0;
  std::map<std::string, int> nearest;  ///< content of the nearest clip -> how often
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LabelCount, prompts, right, nearest)

struct GenerationLabelReport {
  nlohmann::json protocol;  ///< everything that the figures depend on
  int prompts = 0;
  int right = 0;
  double accuracy = 0;
  double standard_error = 0;  ///< of the accuracy, binomial
  /// Accuracy of a gallery clip drawn at random: sum over the labels of share
  /// among the prompts times share in the gallery.
  double chance = 0;
  double gallery_chance = 0;  ///< sum of the squared label shares of the gallery
  std::map<std::string, LabelCount> labels;
  PhysicalSummary physical;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(GenerationLabelReport, protocol, prompts, right, accuracy,
                                   standard_error, chance, gallery_chance, labels, physical)

/// Runs the protocol; `gallery_index` is the index of `database`. Every prompt's
/// outcome is written to `results_path` at once; a run that was stopped
/// (Interrupted) goes on where it was. Throws Error when the file belongs to
/// another protocol, database or generator.
GenerationLabelReport measure_generation_labels(
    const Database& database, const VectorIndex& gallery_index, const GenerateMotion& generate,
    const EmbedMotion& embed, const GenerationLabelOptions& options, const Monitor& monitor = {});

}  // namespace remomask
