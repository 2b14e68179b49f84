#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "db/database.h"
#include "evaluation/label_prompts.h"
#include "evaluation/motion_judge.h"
#include "pipeline/physical.h"
#include "remomask/progress.h"

namespace remomask::evaluation {

// Generates the motions of an evaluation and keeps what became of each, one line
// a motion: the report (generation_report.h) is made of these lines.

/// Generates a canonical motion (22 joints, 20 fps) from prompt.text with prompt.seed.
using GenerateMotion = std::function<Motion(const LabelPrompt& prompt)>;

struct GenerationRunOptions {
  int prompts = 200;  ///< 0: every clip of the split once
  uint64_t seed = 1;
  std::string prompt_split = "test";
  std::string draw = "even";  ///< see parse_prompt_draw()
  std::vector<std::string> gallery_splits = {"train", "val", "test"};
  int repeats = 1;            ///< generations of every prompt, each with its own seed
  int modality_prompts = 10;  ///< the first prompts, for MultiModality; 0: not measured
  int modality_repeats = 30;  ///< generations of each of them beside the repeats
  std::string generator;      ///< identity of the generator (hash, settings), for the stamp
  std::string results_path;   ///< JSON lines; an existing file is continued
};

/// What a motion shows.
struct JudgedMotion {
  std::string nearest_clip, nearest_content;  ///< "" when the motion was not finite
  double distance = 0;                        ///< to the nearest clip, in the judge's space
  bool right = false;                         ///< nearest_content is the prompt's
  std::string shown_side;  ///< "left" or "right"; "" for none, or where none is asked
  PhysicalMetrics physical;
  std::vector<float> embedding;  ///< in the evaluator's space; empty when not finite
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(JudgedMotion, nearest_clip, nearest_content, distance, right,
                                   shown_side, physical, embedding)

/// One motion to generate.
struct GenerationJob {
  int number = 0;
  int prompt = 0;  ///< number of the prompt
  int repeat = 0;  ///< from 0; of MultiModality when `modality`
  bool modality = false;
  uint64_t seed = 0;
};

/// A line of the results.
struct GenerationOutcome {
  int number = 0;
  std::string clip, text, content;
  uint64_t seed = 0;
  JudgedMotion motion;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(GenerationOutcome, number, clip, text, content, seed, motion)

/// Real motions among which the nearest one is looked for.
class JudgeGallery {
 public:
  /// The judge's clips of these splits with a content. Throws Error when there
  /// is none.
  JudgeGallery(const db::Database& database, const MotionJudge& judge,
               const std::vector<std::string>& splits);

  /// `exclude_own_group`: leave out clips of the prompt's group (for real
  /// motions, which would find themselves).
  JudgedMotion judge(const LabelPrompt& prompt, const Motion& motion, const Evaluator& evaluator,
                     bool exclude_own_group) const;

  size_t size() const { return ids_.size(); }
  const std::map<std::string, int>& contents() const { return contents_; }

 private:
  struct Entry {
    std::string name, group, content;
  };
  const MotionJudge& judge_;
  std::vector<int64_t> ids_;  ///< ascending
  std::map<int64_t, Entry> entries_;
  std::map<std::string, int> contents_;
};

struct GenerationRun {
  nlohmann::json protocol;  ///< everything that the figures depend on
  std::vector<LabelPrompt> prompts;
  std::vector<GenerationJob> jobs;
  std::vector<GenerationOutcome> outcomes;  ///< one a job
};

/// Generates and judges all motions. Every outcome is written to `results_path`
/// at once; a run that was stopped (Interrupted) goes on where it was. Throws
/// Error when the file belongs to another protocol, database or generator.
GenerationRun run_generation(const db::Database& database, const JudgeGallery& gallery,
                             const MotionJudge& judge, const Evaluator& evaluator,
                             const GenerateMotion& generate, const GenerationRunOptions& options,
                             const Monitor& monitor = {});

}  // namespace remomask::evaluation
