#include <fmt/format.h>

#include <charconv>
#include <filesystem>

#include "base/file.h"
#include "db/database.h"
#include "encoders/sentence_encoder.h"
#include "encoders/text_file.h"
#include "evaluation/evaluator.h"
#include "evaluation/retrieval_metrics.h"
#include "lab/ablation_charts.h"
#include "lab/ablation_clips.h"
#include "lab/ablation_report.h"
#include "lab/ablation_run.h"
#include "lab/variants.h"
#include "remomask/error.h"
#include "tools/ablate_command.h"
#include "tools/markdown_section.h"

namespace remomask::tools {

namespace {

namespace fs = std::filesystem;

/// "400" for every stage, "masked=400" for one; later ones win.
std::map<std::string, int64_t> stage_numbers(const std::vector<std::string>& words,
                                             const std::string& option) {
  std::map<std::string, int64_t> numbers;
  for (const std::string& word : words) {
    const size_t sign = word.find('=');
    const std::string digits = sign == std::string::npos ? word : word.substr(sign + 1);
    int64_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error != std::errc() || end != digits.data() + digits.size()) {
      throw Error(option + " " + word + ": use a number, or STAGE=NUMBER");
    }
    if (sign != std::string::npos) {
      numbers[word.substr(0, sign)] = number;
      continue;
    }
    for (const char* stage : {"retriever", "tokenizer", "masked", "residual"}) {
      numbers[stage] = number;
    }
  }
  return numbers;
}

std::string short_time(double seconds) {
  return seconds < 90 ? fmt::format("{:.0f} s", seconds) : fmt::format("{:.0f} min", seconds / 60);
}

nlohmann::json plan_json(const lab::AblationPlan& plan, const lab::AblationClock& clock) {
  nlohmann::json jobs = nlohmann::json::array();
  for (const lab::AblationJob& job : plan.jobs) {
    jobs.push_back({{"job", job.title},
                    {"file", job.file},
                    {"done", fs::exists(job.file)},
                    {"gigaoperations", job.gigaoperations},
                    {"seconds", clock.seconds(job)}});
  }
  return {{"jobs", jobs}};
}

void print_plan(const lab::AblationPlan& plan, const lab::AblationClock& clock) {
  double left = 0;
  for (const lab::AblationJob& job : plan.jobs) {
    const bool done = fs::exists(job.file);
    if (!done) left += clock.seconds(job);
    fmt::print("{} {:<44} {:>8}  {}\n", done ? "done" : "    ", job.title,
               short_time(clock.seconds(job)), fs::path(job.file).filename().string());
  }
  fmt::print("{} jobs, about {} left (from the number of weights where nothing was measured)\n",
             plan.jobs.size(), short_time(left));
}

void write_results(const AblateCommand& options, Program& program, const nlohmann::json& document) {
  const fs::path folder = options.folder;
  const std::string table = lab::ablation_markdown(document);
  write_file_atomically((folder / "ablation.json").string(), document.dump(1) + "\n");
  write_file_atomically((folder / "ablation.md").string(), table);
  lab::draw_ablation_bars((folder / "ablation.png").string(), document);
  const bool sweeps =
      lab::draw_ablation_sweeps((folder / "ablation_sweeps.png").string(), document);
  if (!options.docs.empty()) {
    const fs::path docs = options.docs;
    std::string section = table + "\n![bars](ablation.png)\n";
    lab::draw_ablation_bars((docs / "ablation.png").string(), document);
    if (sweeps) {
      lab::draw_ablation_sweeps((docs / "ablation_sweeps.png").string(), document);
      section += "\n![sweeps](ablation_sweeps.png)\n";
    }
    replace_section((docs / "results.md").string(), "ablation", section);
  }
  if (program.json) return program.print_json(document);
  fmt::print("{}", table);
}

}  // namespace

void run_ablate(const AblateCommand& options, Program& program) {
  lab::AblationOptions ablation;
  ablation.folder = options.folder;
  ablation.variants = options.variants;
  if (!options.seeds.empty()) ablation.seeds = options.seeds;
  if (options.preset) ablation.preset = *options.preset;
  if (options.split) ablation.split = *options.split;
  if (options.prompts) ablation.prompts = *options.prompts;
  ablation.guidance_sweep = options.guidance_sweep;
  ablation.steps_sweep = options.steps_sweep;
  if (ablation.variants.empty()) {
    for (const lab::ModelVariant& variant : lab::model_variants())
      ablation.variants.push_back(variant.name);
  }
  ablation.steps = stage_numbers(options.steps, "--steps");
  ablation.batch = stage_numbers(options.batch, "--batch");
  const db::Database database(options.database, db::OpenMode::read_only);
  const evaluation::Evaluator judge =
      evaluation::load_evaluator(options.evaluator.evaluator_path());
  const lab::AblationClips clips =
      lab::load_ablation_clips(database, ablation.split, options.sources);
  const std::string text_path = encoders::text_file_of(options.folder + "/stages/retriever");
  const std::string training = evaluation::clip_set_hash(clips.training.train) +
                               evaluation::clip_set_hash(clips.training.val) +
                               encoders::SentenceEncoder::open(text_path).tower_hash();
  const lab::AblationPlan plan = lab::plan_ablation(
      ablation, {training, training + evaluation::clip_set_hash(clips.asked) + judge.hash()});
  fs::create_directories(ablation.folder);
  lab::AblationClock clock((fs::path(ablation.folder) / "times.json").string());
  if (options.dry_run) {
    if (program.json) return program.print_json(plan_json(plan, clock));
    return print_plan(plan, clock);
  }
  const lab::AblationExam exam =
      lab::make_ablation_exam(judge, database, clips, ablation.prompts, ablation.prompt_seed);
  lab::run_ablation(plan, clips.training, exam, clock, program.monitor());
  program.finish_progress();
  write_results(options, program,
                lab::ablation_document(
                    ablation, plan, exam.grade_real(),
                    {{"hash", judge.hash()},
                     {"file", fs::path(options.evaluator.evaluator_path()).filename().string()}}));
}

}  // namespace remomask::tools
