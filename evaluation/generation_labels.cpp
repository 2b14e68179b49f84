#include "evaluation/generation_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <unordered_map>

#include "base/error.h"
#include "base/file.h"
#include "db/training_set.h"
#include "index/filter.h"

namespace remomask {

namespace {

constexpr const char* kProtocolName = "content label 1";

/// Real motions among which the nearest one is looked for.
struct LabelGallery {
  std::vector<int64_t> ids;  ///< ascending
  std::unordered_map<int64_t, const Clip*> clips;
  std::map<std::string, int> contents;
};

LabelGallery make_label_gallery(const std::vector<Clip>& clips, const VectorIndex& index,
                                const GenerationLabelOptions& options) {
  ClipFilter filter;
  filter.splits = options.gallery_splits;
  LabelGallery gallery;
  for (const Clip& clip : clips) gallery.clips.emplace(clip.id, &clip);
  const auto& indexed = index.clip_ids();
  for (const int64_t id : matching_clips(clips, filter)) {
    const std::string content = clip_content(*gallery.clips.at(id));
    // A clip of unknown content could only be wrong.
    if (content.empty() || !std::binary_search(indexed.begin(), indexed.end(), id)) continue;
    gallery.ids.push_back(id);
    ++gallery.contents[content];
  }
  if (gallery.ids.empty()) {
    throw Error(
        "no clip of the gallery's splits has a content label and a vector; "
        "choose other splits, or run: remomask index DB");
  }
  return gallery;
}

nlohmann::json make_label_protocol(const VectorIndex& index, const LabelGallery& gallery,
                                   const GenerationLabelOptions& options) {
  return {{"protocol", kProtocolName},
          {"database", index.stamp().database_uuid},
          {"database_generation", index.stamp().generation},
          {"retriever", index.stamp().retriever_hash},
          {"generator", options.generator},
          {"prompts", options.prompts},
          {"prompt_split", options.prompt_split},
          {"seed", options.seed},
          {"gallery_splits", options.gallery_splits},
          {"gallery_clips", gallery.ids.size()},
          {"exclude_own_group", options.exclude_own_group}};
}

/// The results of earlier runs and the file that takes the next ones. The first
/// line is the protocol, so that figures of different protocols never mix.
class LabelResults {
 public:
  LabelResults(const std::string& path, const nlohmann::json& protocol) : path_(path) {
    std::string kept = protocol.dump() + "\n";
    if (std::filesystem::exists(path)) read_lines(read_file(path), protocol, kept);
    // Without the half of a line that a killed run may have left.
    write_file_atomically(path, kept);
    file_.open(path, std::ios::app | std::ios::binary);
  }

  const std::vector<LabelOutcome>& outcomes() const { return outcomes_; }

  void add(const LabelOutcome& outcome) {
    file_ << nlohmann::json(outcome).dump() << '\n' << std::flush;
    if (!file_) throw FileError(path_, 0, "cannot write; is the disk full?");
    outcomes_.push_back(outcome);
  }

 private:
  void read_lines(const std::string& content, const nlohmann::json& protocol, std::string& kept) {
    long number = 0;
    size_t start = 0;
    for (size_t end = content.find('\n'); end != std::string::npos;
         start = end + 1, end = content.find('\n', start)) {
      const std::string line = content.substr(start, end - start);
      const auto parsed = nlohmann::json::parse(line, nullptr, false);
      if (++number == 1) {
        if (parsed != protocol) {
          throw FileError(path_, 1,
                          "these results belong to other settings, another database or another "
                          "generator; remove the file, or choose another path");
        }
        continue;
      }
      try {
        outcomes_.push_back(parsed.get<LabelOutcome>());
      } catch (const nlohmann::json::exception&) {
        throw FileError(path_, number, "is no result; remove the line or the file");
      }
      if (outcomes_.back().number != number - 2) {
        throw FileError(path_, number, "a result is missing before this one; remove the file");
      }
      kept += line + "\n";
    }
    if (number == 0 && !content.empty()) {
      throw FileError(path_, 1, "is no file of results; choose another path");
    }
  }

  std::string path_;
  std::vector<LabelOutcome> outcomes_;
  std::ofstream file_;
};

std::vector<int64_t> gallery_for(const LabelPrompt& prompt, const LabelGallery& gallery,
                                 bool exclude_own_group) {
  std::vector<int64_t> ids = gallery.ids;
  if (exclude_own_group) {
    std::erase_if(ids, [&](int64_t id) { return gallery.clips.at(id)->group == prompt.group; });
  }
  return ids;
}

LabelOutcome judge_prompt(const LabelPrompt& prompt, const Motion& motion,
                          const LabelGallery& gallery, const VectorIndex& index,
                          const EmbedMotion& embed, const GenerationLabelOptions& options) {
  LabelOutcome outcome;
  outcome.clip = prompt.clip;
  outcome.text = prompt.text;
  outcome.content = prompt.content;
  outcome.seed = prompt.seed;
  outcome.physical = measure_physical(motion, humanml_skeleton());
  if (!outcome.physical.finite) return outcome;  // wrong by any measure
  const std::vector<float> vector = embed(motion);
  if (static_cast<int>(vector.size()) != index.width()) {
    throw Error(
        fmt::format("the motion's vector has {} numbers, those of the gallery {}; "
                    "use the same retriever for both",
                    vector.size(), index.width()));
  }
  const auto allowed = gallery_for(prompt, gallery, options.exclude_own_group);
  const auto hits = index.search(vector.data(), 1, 1, &allowed).front();
  if (hits.empty()) throw Error("the gallery has no clip outside the group of " + prompt.clip);
  const Clip& nearest = *gallery.clips.at(hits.front().clip_id);
  outcome.nearest_clip = nearest.name;
  outcome.nearest_content = clip_content(nearest);
  outcome.similarity = hits.front().similarity;
  outcome.right = outcome.nearest_content == outcome.content;
  return outcome;
}

GenerationLabelReport make_label_report(const nlohmann::json& protocol,
                                        const std::vector<LabelOutcome>& outcomes,
                                        const LabelGallery& gallery) {
  GenerationLabelReport report;
  report.protocol = protocol;
  report.prompts = static_cast<int>(outcomes.size());
  std::vector<PhysicalMetrics> physical;
  for (const LabelOutcome& outcome : outcomes) {
    LabelCount& label = report.labels[outcome.content];
    ++label.prompts;
    label.right += outcome.right;
    report.right += outcome.right;
    if (outcome.physical.finite) ++label.nearest[outcome.nearest_content];
    physical.push_back(outcome.physical);
  }
  const double prompts = report.prompts;
  const auto gallery_clips = static_cast<double>(gallery.ids.size());
  report.accuracy = report.right / prompts;
  report.standard_error = std::sqrt(report.accuracy * (1 - report.accuracy) / prompts);
  for (const auto& [content, clips] : gallery.contents) {
    const double share = clips / gallery_clips;
    report.gallery_chance += share * share;
    const auto asked = report.labels.find(content);
    if (asked != report.labels.end()) report.chance += share * asked->second.prompts / prompts;
  }
  report.physical = summarise_physical(physical);
  return report;
}

}  // namespace

GenerationLabelReport measure_generation_labels(
    const Database& database, const VectorIndex& gallery_index, const GenerateMotion& generate,
    const EmbedMotion& embed, const GenerationLabelOptions& options, const Monitor& monitor) {
  if (options.prompts < 1) throw Error("the evaluation needs at least one prompt");
  if (options.results_path.empty()) throw Error("the evaluation needs a path for its results");
  gallery_index.require_current(database);
  const std::vector<Clip> clips = database.clips();
  const auto prompts =
      choose_label_prompts(clips, options.prompt_split, options.prompts, options.seed);
  const LabelGallery gallery = make_label_gallery(clips, gallery_index, options);
  const auto protocol = make_label_protocol(gallery_index, gallery, options);
  LabelResults results(options.results_path, protocol);
  int right = 0;
  for (const LabelOutcome& outcome : results.outcomes()) right += outcome.right;
  for (size_t i = results.outcomes().size(); i < prompts.size(); ++i) {
    if (monitor.stop_requested()) {
      throw Interrupted(fmt::format("stopped after {} of {} prompts; the same command goes on", i,
                                    prompts.size()));
    }
    LabelOutcome outcome =
        judge_prompt(prompts[i], generate(prompts[i]), gallery, gallery_index, embed, options);
    outcome.number = static_cast<int>(i);
    right += outcome.right;
    results.add(outcome);
    const auto done = static_cast<double>(i + 1);
    monitor.report({"evaluate labels", done, static_cast<double>(prompts.size()),
                    fmt::format("right {:.1f} %", 100 * right / done)});
  }
  return make_label_report(protocol, results.outcomes(), gallery);
}

}  // namespace remomask
