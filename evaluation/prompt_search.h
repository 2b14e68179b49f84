#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/bootstrap.h"
#include "remomask/progress.h"
#include "search/calibration.h"
#include "search/motion_search.h"
#include "search/word_score.h"

namespace remomask::evaluation {

/// A sentence as somebody types it, with the labels of the clips that answer it.
struct SearchPrompt {
  std::string prompt;
  /// Key -> values: a right clip has for every key one of the values. Empty: nothing in the
  /// database answers the prompt.
  std::map<std::string, std::vector<std::string>> labels;
  long line = 0;
};

/// JSON Lines of {"prompt": "...", "labels": {"actions": ["wave", "goodbye"]}} or "labels": null.
/// Throws FileError with the line for anything else, and for a file without a prompt.
std::vector<SearchPrompt> read_search_prompts(const std::string& path);

/// Whether a clip with these labels answers the prompt.
bool answers_prompt(const nlohmann::json& labels, const SearchPrompt& prompt);

/// How well one way to search finds what the prompts ask for.
struct PromptFigures {
  std::string by;  ///< "all", "captions", "words", "motion", "random"
  int prompts = 0;
  /// Share of the prompts with a right clip among the first 1, 5 and 10, and the mean of
  /// 1 / rank of the first right clip (0 beyond 10).
  double hit_1 = 0, hit_5 = 0, hit_10 = 0, mean_reciprocal_rank = 0;
  std::vector<Interval> intervals;  ///< of the four, over prompts
};

struct PromptReport {
  std::vector<PromptFigures> figures;
  std::vector<search::JudgedFeatures> pairs;         ///< the first ten hits of every prompt, by all
  std::vector<search::JudgedFeatures> motion_pairs;  ///< the same by motion
  std::vector<double> probabilities;                 ///< of these pairs
  std::vector<bool> right;
  std::vector<search::ReliabilityBin> bins;
  double calibration_error = 0;
  int confident = 0;           ///< pairs with a probability above 0.8 ...
  double confident_right = 0;  ///< ... and the share of them that is right
  /// Prompts without an answer: share of those whose best hit is not trusted (below 0.5).
  int unanswerable = 0;
  double refused = 0;
  std::vector<std::string> missed;  ///< prompts without a right clip among the first five
};

struct PromptSearchOptions {
  ClipFilter filter;
  bool each_part = true;  ///< false: by everything and by motion alone, what a fit needs
  BootstrapOptions bootstrap;
};

/// Searches for each prompt by everything and by each part; hits are grouped. `labels` by clip id.
PromptReport measure_prompt_search(const search::MotionSearch& search,
                                   const std::vector<SearchPrompt>& prompts,
                                   const std::map<int64_t, nlohmann::json>& labels,
                                   const PromptSearchOptions& options, const Monitor& monitor = {});

void to_json(nlohmann::json& json, const PromptFigures& figures);

}  // namespace remomask::evaluation
