#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/file.h"
#include "evaluation/evaluator_training.h"
#include "generator/presets.h"
#include "retriever/training.h"
#include "tools/program.h"
#include "tools/training_presets.h"
#include "tools/workspace.h"

namespace remomask {

namespace {

namespace fs = std::filesystem;

struct TrainOptions {
  std::string stage, database, folder, preset = "base", queues = "both";
  std::vector<std::string> captions, sources;
  std::optional<int64_t> steps, batch, queue_size;
  std::optional<double> learning_rate;
  uint64_t seed = 1;
  std::optional<double> same_label_weight;
};

/// Captions of JSON Lines files ({"captions": [...], "split": ...}); those of a
/// test split are left out, as everywhere in training.
void read_more_captions(const std::string& path, std::vector<std::string>& captions) {
  const std::string content = read_file(path);
  size_t begin = 0;
  for (long line = 1; begin < content.size(); ++line) {
    const size_t end = std::min(content.find('\n', begin), content.size());
    const std::string text = content.substr(begin, end - begin);
    begin = end + 1;
    if (text.find_first_not_of(" \r\t") == std::string::npos) continue;
    try {
      const auto entry = nlohmann::json::parse(text);
      if (entry.value("split", "") == "test") continue;
      for (const auto& caption : entry.at("captions")) captions.push_back(caption);
    } catch (const nlohmann::json::exception& error) {
      throw FileError(path, line, std::string("is no line with \"captions\": ") + error.what());
    }
  }
}

class TrainingRun {
 public:
  TrainingRun(const TrainOptions& options, Program& program)
      : options_(options),
        program_(program),
        monitor_(program.monitor()),
        preset_(model_preset(options.preset)),
        database_(options.database, OpenMode::read_only) {
    fs::create_directories(options.folder);
  }

  void run() {
    const std::vector<std::string> order = {"text", "retriever", "tokenizer", "masked", "residual"};
    if (options_.stage != "all") return train(options_.stage);
    for (const std::string& stage : order) {
      if (fs::exists(stage_path(stage))) {
        program_.warn(stage_path(stage) + " is there and is kept; remove it to train it again");
      } else {
        train(stage);
      }
    }
    const std::string path = (fs::path(options_.folder) / "model.safetensors").string();
    std::vector<ModelStage> stages;
    for (const std::string& stage : order) {
      if (stage != "text") stages.push_back(load_stage(stage_path(stage), stage));
    }
    save_model(path, stages, /*half=*/true);
    program_.finish_progress();
    fmt::print("{}\n", path);
  }

 private:
  std::string stage_path(const std::string& stage) const {
    return (fs::path(options_.folder) / (stage + ".safetensors")).string();
  }

  const std::vector<TrainingClip>& clips(const std::string& split) {
    auto& kept = clips_[split];
    if (kept.empty()) {
      TrainingSetOptions set;
      set.splits = {split};
      set.sources = options_.sources;
      set.add_mirrored = split == "train";
      kept = load_training_set(database_, set);
      if (kept.empty()) {
        throw FileError(options_.database, 0, "has no clips of split \"" + split + "\"");
      }
    }
    return kept;
  }

  template <typename Options>
  Options adjusted(Options options, const std::string& stage) {
    if (options_.steps) options.trainer.steps = *options_.steps;
    if (options_.learning_rate) options.trainer.learning_rate = *options_.learning_rate;
    options.trainer.warmup_steps =
        std::min(options.trainer.warmup_steps, std::max<int64_t>(1, options.trainer.steps / 10));
    options.trainer.seed = options_.seed;
    options.trainer.checkpoint_path = stage_path(stage) + ".checkpoint";
    return options;
  }

  void train(const std::string& stage) {
    const ModelStage result = stage == "evaluator"   ? train_evaluator_stage()
                              : stage == "text"      ? train_text()
                              : stage == "retriever" ? train_retriever_stage()
                              : stage == "tokenizer" ? train_tokenizer_stage()
                              : stage == "masked"    ? train_masked_stage()
                                                     : train_residual_stage();
    save_model(stage_path(stage), {result}, /*half=*/stage == "evaluator");
    fs::remove(stage_path(stage) + ".checkpoint");
    fs::remove(stage_path(stage) + ".checkpoint.movement");
    program_.finish_progress();
    if (options_.stage != "all") fmt::print("{}\n", stage_path(stage));
  }

  ModelStage train_text() {
    std::vector<std::string> captions;
    for (const TrainingClip& clip : clips("train")) {
      captions.insert(captions.end(), clip.captions.begin(), clip.captions.end());
    }
    for (const std::string& path : options_.captions) read_more_captions(path, captions);
    auto options = adjusted(text_training_preset(options_.preset), "text");
    if (options_.batch) options.batch = *options_.batch;
    return train_text_encoder(captions, text_encoder_preset(options_.preset), options, monitor_);
  }

  ModelStage train_retriever_stage() {
    std::optional<ModelStage> text;
    if (fs::exists(stage_path("text"))) text = load_stage(stage_path("text"), "text");
    auto options = adjusted(RetrieverTrainingOptions(options_.preset), "retriever");
    if (options_.batch) options.batch = *options_.batch;
    options.queues = parse_queues(options_.queues);
    if (options_.queue_size) options.queue_size = *options_.queue_size;
    if (options_.same_label_weight) options.same_meaning_weight = *options_.same_label_weight;
    return train_retriever(clips("train"), clips("val"), text, preset_.retriever, options,
                           monitor_);
  }

  ModelStage train_tokenizer_stage() {
    auto options = adjusted(tokenizer_training_preset(options_.preset), "tokenizer");
    if (options_.batch) options.batch_frames = *options_.batch * options.window;
    return train_tokenizer(clips("train"), clips("val"), preset_.tokenizer, options, monitor_);
  }

  ModelStage train_masked_stage() {
    return train_masked(preset_.masked, generator_data(), transformer_options("masked"), monitor_);
  }

  ModelStage train_residual_stage() {
    return train_residual(preset_.residual, generator_data(), transformer_options("residual"),
                          monitor_);
  }

  ModelStage train_evaluator_stage() {
    auto options = adjusted(EvaluatorTrainingOptions(options_.preset), "evaluator");
    options.movement.seed = options_.seed;
    if (options_.batch) options.batch = *options_.batch;
    return train_evaluator(clips("train"), clips("val"), evaluator_preset(options_.preset), options,
                           monitor_);
  }

  TransformerTrainingOptions transformer_options(const std::string& stage) {
    auto options = adjusted(stage == "masked" ? masked_training_preset(options_.preset)
                                              : residual_training_preset(options_.preset),
                            stage);
    if (options_.batch) options.batch = *options_.batch;
    return options;
  }

  const GeneratorData& generator_data() {
    if (!generator_data_) {
      const Tokenizer tokenizer(load_stage(stage_path("tokenizer"), "tokenizer"));
      const Retriever retriever(load_stage(stage_path("retriever"), "retriever"));
      generator_data_ =
          prepare_generator_data(clips("train"), clips("val"), tokenizer, retriever, monitor_);
    }
    return *generator_data_;
  }

  const TrainOptions& options_;
  Program& program_;
  Monitor monitor_;
  ModelConfig preset_;
  Database database_;
  std::map<std::string, std::vector<TrainingClip>> clips_;
  std::optional<GeneratorData> generator_data_;
};

}  // namespace

void register_train(CLI::App& app, Program& program) {
  auto options = std::make_shared<TrainOptions>();
  CLI::App* command =
      add_command(app, "train", "train one network or all; the same command resumes",
                  "remomask train all --db motions.sqlite --preset base -o run");
  command
      ->add_option("stage", options->stage,
                   "text, retriever, tokenizer, masked, residual, all (of these), evaluator")
      ->required()
      ->check(CLI::IsMember(
          {"text", "retriever", "tokenizer", "masked", "residual", "all", "evaluator"}));
  command->add_option("--db", options->database, "database with splits train and val")->required();
  command->add_option("-o,--output", options->folder, "folder of the stage files")->required();
  command->add_option("--preset", options->preset, "tiny, base, paper or momask")
      ->capture_default_str()
      ->check(CLI::IsMember({"tiny", "base", "paper", "momask"}));
  command->add_option("--source", options->sources, "only these data sets (repeatable)");
  command->add_option("--captions", options->captions,
                      "more captions for the text encoder: JSON Lines with \"captions\"");
  command->add_option("--steps", options->steps, "steps; default: of the preset")
      ->check(CLI::PositiveNumber);
  command->add_option("--batch", options->batch, "clips a step; default: of the preset")
      ->check(CLI::PositiveNumber);
  command->add_option("--rate", options->learning_rate, "learning rate; default: of the preset")
      ->check(CLI::PositiveNumber);
  command->add_option("--seed", options->seed, "of weights, order and masks")
      ->capture_default_str();
  command->add_option("--queues", options->queues, "negatives of the retriever besides the batch")
      ->capture_default_str()
      ->check(CLI::IsMember({"none", "motion", "text", "both"}));
  command
      ->add_option("--queue-size", options->queue_size,
                   "entries of each queue; default: of the "
                   "preset")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--same-label-weight", options->same_label_weight,
                   "retriever: weight of clips with equal labels content and style as negatives of "
                   "each other; default: of the preset")
      ->check(CLI::Range(0.0, 1.0));
  command->callback([options, &program] { TrainingRun(*options, program).run(); });
}

}  // namespace remomask
