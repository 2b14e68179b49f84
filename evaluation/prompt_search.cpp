#include "evaluation/prompt_search.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/json.h"
#include "base/random.h"
#include "db/clip_filter.h"
#include "remomask/error.h"
#include "search/word_ranking.h"
#include "text/encoding.h"

namespace remomask::evaluation {

namespace {

constexpr int kHits = 10;
constexpr double kConfident = 0.8, kTrusted = 0.5;
constexpr uint64_t kRandomStream = 0x70726f6d;

SearchPrompt parse_prompt(const nlohmann::json& json) {
  SearchPrompt prompt;
  json.at("prompt").get_to(prompt.prompt);
  const nlohmann::json& labels = json.at("labels");
  if (!labels.is_null()) labels.get_to(prompt.labels);
  return prompt;
}

/// Ranks of the first right clip of the answerable prompts, 0: none among the first ten.
using FirstRanks = std::vector<int>;

std::vector<double> figures_of(const FirstRanks& ranks, const std::vector<size_t>& chosen) {
  std::vector<double> sums(4, 0);
  for (const size_t i : chosen) {
    const int rank = ranks[i];
    if (rank == 0) continue;
    sums[0] += rank <= 1 ? 1 : 0;
    sums[1] += rank <= 5 ? 1 : 0;
    sums[2] += 1;
    sums[3] += 1.0 / rank;
  }
  for (double& sum : sums) sum /= std::max<double>(1, static_cast<double>(chosen.size()));
  return sums;
}

PromptFigures summarise(const std::string& by, const FirstRanks& ranks,
                        const BootstrapOptions& bootstrap) {
  std::vector<size_t> all(ranks.size());
  for (size_t i = 0; i < all.size(); ++i) all[i] = i;
  const std::vector<double> values = figures_of(ranks, all);
  PromptFigures figures{
      by, static_cast<int>(ranks.size()), values[0], values[1], values[2], values[3], {}};
  figures.intervals = bootstrap_intervals(
      {ranks.size()}, [&](const std::vector<size_t>& chosen) { return figures_of(ranks, chosen); },
      bootstrap);
  return figures;
}

class Measurement {
 public:
  Measurement(const search::MotionSearch& search, const std::map<int64_t, nlohmann::json>& labels,
              const ClipFilter& filter)
      : search_(search), labels_(labels), filter_(filter) {}

  SearchAnswer answer(const SearchPrompt& prompt, SearchBy by) const {
    SearchQuery query;
    query.text = prompt.prompt;
    query.by = by;
    query.k = kHits;
    query.filter = filter_;
    return search_.search(query);
  }

  bool is_right(const SearchPrompt& prompt, int64_t clip_id) const {
    return answers_prompt(labels_.at(clip_id), prompt);
  }

  int first_right(const SearchPrompt& prompt, const SearchAnswer& answer) const {
    for (const MotionHit& hit : answer.hits) {
      if (is_right(prompt, hit.clip.id)) return hit.rank;
    }
    return 0;
  }

  /// Ten clips drawn by chance.
  int random_rank(const SearchPrompt& prompt, size_t number) const {
    CounterRandom random(number, kRandomStream);
    for (int rank = 1; rank <= kHits; ++rank) {
      auto clip = labels_.begin();
      std::advance(clip, static_cast<std::ptrdiff_t>(random.below(labels_.size())));
      if (answers_prompt(clip->second, prompt)) return rank;
    }
    return 0;
  }

  void add_pairs(const SearchPrompt& prompt, const SearchAnswer& answer,
                 PromptReport& report) const {
    const unsigned sides = search::named_sides(prompt.prompt);
    for (const MotionHit& hit : answer.hits) {
      if (!hit.parts || !hit.probability) continue;
      search::JudgedFeatures pair;
      const WordParts& parts = *hit.parts;
      pair.features.captions = parts.best.has_value();
      pair.features.best = parts.best.value_or(0);
      pair.features.mean = parts.mean.value_or(0);
      pair.features.words = parts.words;
      pair.features.motion = parts.motion;
      pair.features.share = parts.share;
      const unsigned named = search::named_sides(parts.caption);
      pair.features.other_side =
          !hit.as_mirrored && named != 0 && sides != 0 && (named & sides) == 0;
      pair.right = is_right(prompt, hit.clip.id);
      report.pairs.push_back(pair);
      report.probabilities.push_back(*hit.probability);
      report.right.push_back(pair.right);
    }
  }

  void add_motion_pairs(const SearchPrompt& prompt, const SearchAnswer& answer,
                        PromptReport& report) const {
    for (const MotionHit& hit : answer.hits) {
      search::JudgedFeatures pair;
      pair.features.motion = hit.similarity;
      pair.right = is_right(prompt, hit.clip.id);
      report.motion_pairs.push_back(pair);
    }
  }

 private:
  const search::MotionSearch& search_;
  const std::map<int64_t, nlohmann::json>& labels_;
  const ClipFilter& filter_;
};

void summarise_probabilities(PromptReport& report) {
  report.bins = search::reliability_bins(report.probabilities, report.right);
  report.calibration_error = search::expected_calibration_error(report.bins);
  int right = 0;
  for (size_t i = 0; i < report.right.size(); ++i) {
    if (report.probabilities[i] <= kConfident) continue;
    ++report.confident;
    right += report.right[i] ? 1 : 0;
  }
  report.confident_right = report.confident > 0 ? static_cast<double>(right) / report.confident : 0;
}

}  // namespace

std::vector<SearchPrompt> read_search_prompts(const std::string& path) {
  std::istringstream lines(text::read_text_file(path));
  std::vector<SearchPrompt> prompts;
  long number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    try {
      prompts.push_back(parse_prompt(parse_json(line)));
    } catch (const nlohmann::json::exception& error) {
      throw FileError(path, number,
                      "is no line like {\"prompt\": \"...\", \"labels\": {\"actions\": "
                      "[\"wave\"]}}: " +
                          json_reason(error));
    }
    prompts.back().line = number;
  }
  if (prompts.empty()) throw FileError(path, 0, "holds no prompt");
  return prompts;
}

bool answers_prompt(const nlohmann::json& labels, const SearchPrompt& prompt) {
  return !prompt.labels.empty() &&
         std::all_of(prompt.labels.begin(), prompt.labels.end(), [&](const auto& condition) {
           return std::any_of(condition.second.begin(), condition.second.end(),
                              [&](const std::string& value) {
                                return db::has_label(labels, {condition.first, value});
                              });
         });
}

PromptReport measure_prompt_search(const search::MotionSearch& search,
                                   const std::vector<SearchPrompt>& prompts,
                                   const std::map<int64_t, nlohmann::json>& labels,
                                   const PromptSearchOptions& options, const Monitor& monitor) {
  const Measurement measurement(search, labels, options.filter);
  std::vector<SearchBy> ways = {SearchBy::all};
  if (options.each_part) ways.insert(ways.end(), {SearchBy::captions, SearchBy::words});
  ways.push_back(SearchBy::motion);
  std::map<SearchBy, FirstRanks> ranks;
  FirstRanks random;
  PromptReport report;
  int refused = 0;
  for (size_t i = 0; i < prompts.size(); ++i) {
    if (monitor.stop_requested()) throw Interrupted("the evaluation was stopped");
    const SearchPrompt& prompt = prompts[i];
    const bool answerable = !prompt.labels.empty();
    for (const SearchBy by : ways) {
      if (by != SearchBy::all && by != SearchBy::motion && !answerable) continue;
      const SearchAnswer answer = measurement.answer(prompt, by);
      if (by == SearchBy::motion) {
        measurement.add_motion_pairs(prompt, answer, report);
        if (!answerable) continue;
      }
      if (by == SearchBy::all) {
        measurement.add_pairs(prompt, answer, report);
        const bool trusted =
            !answer.hits.empty() && answer.hits.front().probability.value_or(0) >= kTrusted;
        if (!answerable) {
          ++report.unanswerable;
          refused += trusted ? 0 : 1;
          continue;
        }
      }
      ranks[by].push_back(measurement.first_right(prompt, answer));
      if (by == SearchBy::all && (ranks[by].back() == 0 || ranks[by].back() > 5)) {
        report.missed.push_back(prompt.prompt);
      }
    }
    if (answerable) random.push_back(measurement.random_rank(prompt, i));
    monitor.report(
        {"search", static_cast<double>(i + 1), static_cast<double>(prompts.size()), "prompts"});
  }
  for (const SearchBy by : ways) {
    report.figures.push_back(summarise(search_by_name(by), ranks[by], options.bootstrap));
  }
  report.figures.push_back(summarise("random", random, options.bootstrap));
  report.refused = report.unanswerable > 0 ? static_cast<double>(refused) / report.unanswerable : 0;
  summarise_probabilities(report);
  return report;
}

void to_json(nlohmann::json& json, const PromptFigures& figures) {
  json = {{"by", figures.by},         {"prompts", figures.prompts},
          {"hit_1", figures.hit_1},   {"hit_5", figures.hit_5},
          {"hit_10", figures.hit_10}, {"mean_reciprocal_rank", figures.mean_reciprocal_rank}};
  if (figures.intervals.empty()) return;
  for (const Interval& interval : figures.intervals) {
    json["intervals"].push_back({interval.low, interval.high});
  }
}

}  // namespace remomask::evaluation
