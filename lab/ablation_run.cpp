#include "lab/ablation_run.h"

#include <fmt/format.h>
#include <torch/types.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <set>

#include "base/file.h"
#include "base/json.h"
#include "motion/features.h"
#include "nn/tensor_values.h"
#include "pipeline/evidence.h"
#include "remomask/error.h"

namespace remomask::lab {

namespace {

namespace fs = std::filesystem;

constexpr double kGuessedSpeed = 10;  // 10^9 operations a second

std::string job_key(const AblationJob& job) { return fs::path(job.file).filename().string(); }

/// Evidence from the training clips: one clip of each group, none of the prompt's own group.
class TrainingSource final : public pipeline::EvidenceSource {
 public:
  TrainingSource(const training::GeneratorData& data, const std::vector<db::TrainingClip>& train,
                 int own_group)
      : data_(data), train_(train), own_group_(own_group) {}

  search::FoundClips find(const std::string&, const std::vector<float>& query, int k,
                          const ClipFilter&) const override {
    const at::Tensor vector = torch::tensor(query);
    const at::Tensor similarity = data_.motion.matmul(vector);
    const at::Tensor order = torch::argsort(similarity, 0, /*descending=*/true);
    std::vector<search::FoundClip> found;
    std::set<int> taken = {own_group_};
    for (int64_t rank = 0; rank < order.size(0) && static_cast<int>(found.size()) < k; ++rank) {
      const auto clip = order[rank].item<int64_t>();
      const training::TokenClip& entry = data_.train.clips[static_cast<size_t>(clip)];
      if (!taken.insert(entry.group).second) continue;
      search::FoundClip hit;
      hit.hit.clip.id = clip;
      hit.hit.rank = static_cast<int>(found.size()) + 1;
      hit.hit.similarity = similarity[clip].item<float>();
      hit.motion = nn::float_vector(data_.motion[clip]);
      hit.text = nn::float_vector(data_.motion_text[clip]);
      found.push_back(std::move(hit));
    }
    return {std::move(found), {}};
  }

  Motion motion(int64_t clip) const override {
    const training::TokenClip& entry = data_.train.clips[static_cast<size_t>(clip)];
    return motion::recover_motion(train_[entry.source].features, humanml_skeleton());
  }

 private:
  const training::GeneratorData& data_;
  const std::vector<db::TrainingClip>& train_;
  int own_group_;
};

/// Passes the monitor of one job on as progress of the whole plan.
class PlanProgress {
 public:
  PlanProgress(const AblationPlan& plan, const AblationClock& clock, const Monitor& monitor)
      : plan_(plan), clock_(clock), monitor_(monitor) {}

  /// The monitor of job `number`, which is 0 at its beginning.
  Monitor of_job(size_t number) const {
    Monitor job;
    job.stop = monitor_.stop;
    job.progress = [this, number](const Progress& progress) {
      const bool own = progress.stage.starts_with("train ") || progress.stage == "answer prompts";
      report(number, own && progress.total > 0 ? progress.done / progress.total : 0,
             progress.detail);
    };
    return job;
  }

  void report(size_t number, double share, const std::string& detail) const {
    double done = 0, total = 0;
    for (size_t i = 0; i < plan_.jobs.size(); ++i) {
      const double seconds = clock_.seconds(plan_.jobs[i]);
      total += seconds;
      if (i < number) done += seconds;
      if (i == number) done += share * seconds;
    }
    const bool ended = number == plan_.jobs.size();
    const std::string title =
        ended ? "all done"
              : fmt::format("job {} of {}: {} {:.0f} %  {}", number + 1, plan_.jobs.size(),
                            plan_.jobs[number].title, 100 * share, detail);
    monitor_.report({"ablate", std::round(ended ? total : done), std::round(total), title});
  }

 private:
  const AblationPlan& plan_;
  const AblationClock& clock_;
  const Monitor& monitor_;
};

nlohmann::json trial_document(const AblationPlan& plan, const AblationTrial& trial,
                              const ExamResult& result) {
  const AblationModel& model = plan.models[trial.model];
  nlohmann::json document = {{"variant", model.variant},
                             {"seed", model.seed},
                             {"sweep", trial.sweep},
                             {"sampling", sampling_description(trial.sampling)},
                             {"figures", result}};
  for (const auto& [stage, file] : model.files) {
    const nlohmann::json config = nn::load_stage(file, stage).config;
    const auto& place = config.contains("training") ? config["training"] : config;
    if (place.contains("history") && !place["history"].empty()) {
      document["validation"][stage] = place["history"].back();
    }
  }
  return document;
}

}  // namespace

AblationClock::AblationClock(std::string path) : path_(std::move(path)) {
  if (!fs::exists(path_)) return;
  measured_ = try_parse_json(read_file(path_));
  if (!measured_.is_object()) {
    throw FileError(path_, 0, "is no record of times; remove it");
  }
}

void AblationClock::note(const AblationJob& job, double seconds) {
  measured_[job_key(job)] = {
      {"kind", job.kind}, {"seconds", seconds}, {"gigaoperations", job.gigaoperations}};
  write_file_atomically(path_, measured_.dump(1));
}

double AblationClock::seconds(const AblationJob& job) const {
  if (const auto found = measured_.find(job_key(job)); found != measured_.end()) {
    return found->at("seconds");
  }
  double kind_seconds = 0, kind_operations = 0, all_seconds = 0, all_operations = 0;
  for (const auto& entry : measured_) {
    const double seconds = entry.at("seconds"), operations = entry.at("gigaoperations");
    all_seconds += seconds;
    all_operations += operations;
    if (entry.at("kind") != job.kind) continue;
    kind_seconds += seconds;
    kind_operations += operations;
  }
  if (kind_operations > 0) return job.gigaoperations * kind_seconds / kind_operations;
  if (all_operations > 0) return job.gigaoperations * all_seconds / all_operations;
  return job.gigaoperations / kGuessedSpeed;
}

std::vector<Motion> generate_answers(const AblationModel& model, const SamplingOptions& sampling,
                                     const std::vector<evaluation::LabelPrompt>& prompts,
                                     const std::vector<int>& groups,
                                     const training::GeneratorData& data,
                                     const std::vector<db::TrainingClip>& train,
                                     const Monitor& monitor) {
  std::map<std::string, nn::ModelStage> stages;
  for (const auto& [stage, file] : model.files) {
    stages.emplace(stage, nn::load_stage(file, stage));
  }
  const pipeline::Generator generator(std::make_shared<retriever::Retriever>(
                                          retriever::open_retriever(model.files.at("retriever"))),
                                      stages);
  Monitor stop_only;
  stop_only.stop = monitor.stop;
  std::vector<Motion> motions;
  for (size_t i = 0; i < prompts.size(); ++i) {
    const evaluation::LabelPrompt& prompt = prompts[i];
    GenerateOptions options;
    options.seconds = prompt.frames / humanml_skeleton().fps;
    options.seed = prompt.seed;
    options.sampling = sampling;
    options.follow = 0;  // what the networks make, not what a retrieved motion gives
    const TrainingSource source(data, train, groups[i]);
    const auto found = pipeline::find_evidence(generator, source, prompt.text, options);
    motions.push_back(generator.generate(prompt.text, found.motions, options, stop_only).motion);
    monitor.report(
        {"answer prompts", static_cast<double>(i + 1), static_cast<double>(prompts.size()), ""});
  }
  return motions;
}

void run_ablation(const AblationPlan& plan, const training::TrainingSplits& clips,
                  const AblationExam& exam, AblationClock& clock, const Monitor& monitor) {
  using Clock = std::chrono::steady_clock;
  training::GeneratorDataCache prepared;
  const PlanProgress progress(plan, clock, monitor);
  for (size_t number = 0; number < plan.jobs.size(); ++number) {
    const AblationJob& job = plan.jobs[number];
    if (fs::exists(job.file)) continue;
    if (monitor.stop_requested()) {
      throw Interrupted(
          fmt::format("the ablation stopped before job {} of {}; the same command "
                      "goes on",
                      number + 1, plan.jobs.size()));
    }
    progress.report(number, 0, "");
    fs::create_directories(fs::path(job.file).parent_path());
    const auto start = Clock::now();
    const Monitor job_monitor = progress.of_job(number);
    if (job.kind == "trial") {
      const AblationTrial& trial = plan.trials[job.item];
      const AblationModel& model = plan.models[trial.model];
      const training::GeneratorData& data = prepared.get(
          model.files.at("tokenizer"), model.files.at("retriever"), clips, job_monitor);
      const auto motions = generate_answers(model, trial.sampling, exam.prompts(), exam.groups(),
                                            data, clips.train, job_monitor);
      write_file_atomically(trial.file,
                            trial_document(plan, trial, exam.grade(motions)).dump(1) + "\n");
    } else {
      const AblationModel& model = plan.models[job.item];
      const training::StageFile file = [&](const std::string& stage) {
        return model.files.at(stage);
      };
      training::train_stage(model.recipe, job.kind, file, clips, prepared, job_monitor);
    }
    clock.note(job, std::chrono::duration<double>(Clock::now() - start).count());
  }
  progress.report(plan.jobs.size(), 0, "");
}

}  // namespace remomask::lab
