#include "evaluation/generation_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/file.h"
#include "base/json.h"
#include "base/random.h"
#include "db/clip_filter.h"
#include "db/training_set.h"
#include "evaluation/side_rule.h"
#include "nn/tensor_values.h"
#include "remomask/error.h"

namespace remomask::evaluation {

namespace {

constexpr const char* kProtocolName = "generation 2";
constexpr uint64_t kRepeatStream = 0x726570, kModalityStream = 0x6d6f64;

std::vector<GenerationJob> make_jobs(const std::vector<LabelPrompt>& prompts,
                                     const GenerationRunOptions& options) {
  std::vector<GenerationJob> jobs;
  const auto add = [&](size_t prompt, int repeat, bool modality, uint64_t seed) {
    jobs.push_back(
        {static_cast<int>(jobs.size()), static_cast<int>(prompt), repeat, modality, seed});
  };
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    for (size_t i = 0; i < prompts.size(); ++i) {
      const uint64_t seed = prompts[i].seed;
      add(i, repeat, false,
          repeat == 0 ? seed : mix_seed(seed, static_cast<uint64_t>(repeat), kRepeatStream));
    }
  }
  const size_t several = std::min(prompts.size(), static_cast<size_t>(options.modality_prompts));
  for (size_t i = 0; i < several; ++i) {
    for (int repeat = 0; repeat < options.modality_repeats; ++repeat) {
      add(i, repeat, true,
          mix_seed(prompts[i].seed, static_cast<uint64_t>(repeat), kModalityStream));
    }
  }
  return jobs;
}

nlohmann::json make_protocol(const db::Database& database, const JudgeGallery& gallery,
                             const MotionJudge& judge, const Evaluator& evaluator,
                             const GenerationRunOptions& options) {
  return {{"protocol", kProtocolName},
          {"database", database.uuid()},
          {"database_generation", database.generation()},
          {"judge", judge.identity()},
          {"evaluator", evaluator.hash()},
          {"generator", options.generator},
          {"prompts", options.prompts},
          {"prompt_split", options.prompt_split},
          {"draw", options.draw},
          {"seed", options.seed},
          {"repeats", options.repeats},
          {"modality_prompts", options.modality_prompts},
          {"modality_repeats", options.modality_repeats},
          {"gallery_splits", options.gallery_splits},
          {"gallery_clips", gallery.size()}};
}

/// The results of earlier runs and the file that takes the next ones. The first
/// line is the protocol, so that figures of different protocols never mix.
class GenerationResults {
 public:
  GenerationResults(const std::string& path, const nlohmann::json& protocol) : path_(path) {
    std::string kept = protocol.dump() + "\n";
    if (std::filesystem::exists(path)) read_lines(read_file(path), protocol, kept);
    // Without the half of a line that a killed run may have left.
    write_file_atomically(path, kept);
    file_.open(path, std::ios::app | std::ios::binary);
  }

  const std::vector<GenerationOutcome>& outcomes() const { return outcomes_; }

  void add(const GenerationOutcome& outcome) {
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
      const auto parsed = try_parse_json(line);
      if (++number == 1) {
        if (parsed != protocol) {
          throw FileError(path_, 1,
                          "these results belong to other settings, another database or another "
                          "generator; remove the file, or choose another path");
        }
        continue;
      }
      try {
        outcomes_.push_back(parsed.get<GenerationOutcome>());
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
  std::vector<GenerationOutcome> outcomes_;
  std::ofstream file_;
};

}  // namespace

JudgeGallery::JudgeGallery(const db::Database& database, const MotionJudge& judge,
                           const std::vector<std::string>& splits)
    : judge_(judge) {
  const std::vector<db::Clip> clips = database.clips();
  std::map<int64_t, const db::Clip*> by_id;
  for (const db::Clip& clip : clips) by_id.emplace(clip.id, &clip);
  ClipFilter filter;
  filter.splits = splits;
  const auto& known = judge.clip_ids();
  for (const int64_t id : db::matching_clips(clips, filter)) {
    const db::Clip& clip = *by_id.at(id);
    const std::string content = db::clip_content(clip);
    // A clip of unknown content could only be wrong.
    if (content.empty() || !std::binary_search(known.begin(), known.end(), id)) continue;
    ids_.push_back(id);
    entries_.emplace(id, Entry{clip.name, clip.group, content});
    ++contents_[content];
  }
  if (ids_.empty()) {
    throw Error(
        "no clip of the gallery's splits has a content label and a vector; "
        "choose other splits, or run: remomask index DB");
  }
}

JudgedMotion JudgeGallery::judge(const LabelPrompt& prompt, const Motion& motion,
                                 const Evaluator& evaluator, bool exclude_own_group) const {
  JudgedMotion result;
  const Skeleton& skeleton = humanml_skeleton();
  result.physical = pipeline::measure_physical(motion, skeleton);
  if (!result.physical.finite) return result;  // wrong by any measure
  result.embedding = nn::float_vector(evaluator.embed_motion(motion));
  result.shown_side = shown_side_name(prompt.text, motion, skeleton);
  std::vector<int64_t> allowed = ids_;
  if (exclude_own_group) {
    std::erase_if(allowed, [&](int64_t id) { return entries_.at(id).group == prompt.group; });
  }
  const auto near = judge_.nearest(judge_.embed(motion), allowed);
  if (!near) throw Error("the gallery has no clip outside the group of " + prompt.clip);
  const Entry& nearest = entries_.at(near->clip_id);
  result.nearest_clip = nearest.name;
  result.nearest_content = nearest.content;
  result.distance = near->distance;
  result.right = nearest.content == prompt.content;
  return result;
}

GenerationRun run_generation(const db::Database& database, const JudgeGallery& gallery,
                             const MotionJudge& judge, const Evaluator& evaluator,
                             const GenerateMotion& generate, const GenerationRunOptions& options,
                             const Monitor& monitor) {
  if (options.repeats < 1) throw Error("the evaluation needs at least one repeat");
  if (options.results_path.empty()) throw Error("the evaluation needs a path for its results");
  GenerationRun run;
  run.prompts = choose_label_prompts(database.clips(), options.prompt_split, options.prompts,
                                     options.seed, parse_prompt_draw(options.draw));
  run.jobs = make_jobs(run.prompts, options);
  run.protocol = make_protocol(database, gallery, judge, evaluator, options);
  GenerationResults results(options.results_path, run.protocol);
  int right = 0;
  for (const GenerationOutcome& outcome : results.outcomes()) right += outcome.motion.right;
  for (size_t i = results.outcomes().size(); i < run.jobs.size(); ++i) {
    if (monitor.stop_requested()) {
      throw Interrupted(fmt::format("stopped after {} of {} motions; the same command goes on", i,
                                    run.jobs.size()));
    }
    const GenerationJob& job = run.jobs[i];
    LabelPrompt prompt = run.prompts[static_cast<size_t>(job.prompt)];
    prompt.seed = job.seed;
    const JudgedMotion judged =
        gallery.judge(prompt, generate(prompt), evaluator, /*exclude_own_group=*/false);
    results.add({job.number, prompt.clip, prompt.text, prompt.content, prompt.seed, judged});
    right += judged.right;
    const auto done = static_cast<double>(i + 1);
    monitor.report({"evaluate generation", done, static_cast<double>(run.jobs.size()),
                    fmt::format("right {:.1f} %", 100 * right / done)});
  }
  run.outcomes = results.outcomes();
  return run;
}

}  // namespace remomask::evaluation
