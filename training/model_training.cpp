#include "training/model_training.h"

#include <filesystem>

#include "db/database.h"
#include "encoders/text_file.h"
#include "nn/model_file.h"
#include "pipeline/stage_gate.h"
#include "remomask/error.h"

namespace remomask::training {

namespace {

namespace fs = std::filesystem;

template <typename Options>
Options with_checkpoint(Options options, const std::string& path) {
  options.trainer.checkpoint_path = path;
  return options;
}

nn::ModelStage trained_retriever(const TrainingRecipe& recipe, const std::string& checkpoint,
                                 const StageFile& file, const TrainingSplits& clips,
                                 const Monitor& monitor) {
  const auto words = std::make_shared<const encoders::SentenceEncoder>(
      encoders::SentenceEncoder::open(encoders::text_file_of(file("retriever"))));
  return train_retriever(clips.train, clips.val, words, recipe.model.retriever,
                         with_checkpoint(recipe.retriever_training, checkpoint), monitor);
}

}  // namespace

TrainingSplits load_splits(const std::string& database_path,
                           const std::vector<std::string>& sources) {
  const db::Database database(database_path, db::OpenMode::read_only);
  const auto load = [&](const std::string& split) {
    db::TrainingSetOptions set;
    set.splits = {split};
    set.sources = sources;
    set.add_mirrored = split == "train";
    auto clips = db::load_training_set(database, set);
    if (clips.empty()) {
      throw FileError(database_path, 0, "has no clips of split \"" + split + "\"");
    }
    return clips;
  };
  return {load("train"), load("val")};
}

const GeneratorData& GeneratorDataCache::get(const std::string& tokenizer_file,
                                             const std::string& retriever_file,
                                             const TrainingSplits& clips, const Monitor& monitor) {
  const std::string files = tokenizer_file + "\n" + retriever_file;
  if (!data_ || files_ != files) {
    const tokenizer::Tokenizer tokenizer(nn::load_stage(tokenizer_file, "tokenizer"));
    const retriever::Retriever retriever = retriever::open_retriever(retriever_file);
    data_ = prepare_generator_data(clips.train, clips.val, tokenizer, retriever, monitor);
    files_ = files;
  }
  return *data_;
}

void train_stage(const TrainingRecipe& recipe, const std::string& stage, const StageFile& file,
                 const TrainingSplits& clips, GeneratorDataCache& prepared,
                 const Monitor& monitor) {
  const std::string checkpoint = file(stage) + ".checkpoint";
  const auto data = [&]() -> const GeneratorData& {
    return prepared.get(file("tokenizer"), file("retriever"), clips, monitor);
  };
  nn::ModelStage result;
  if (stage == "retriever") {
    result = trained_retriever(recipe, checkpoint, file, clips, monitor);
  } else if (stage == "tokenizer") {
    result = train_tokenizer(clips.train, clips.val, recipe.model.tokenizer,
                             with_checkpoint(recipe.tokenizer_training, checkpoint), monitor);
  } else if (stage == "masked") {
    result = train_masked(recipe.model.masked, data(),
                          with_checkpoint(recipe.masked_training, checkpoint), monitor);
  } else if (stage == "residual") {
    result = train_residual(recipe.model.residual, data(),
                            with_checkpoint(recipe.residual_training, checkpoint), monitor);
  } else {
    throw Error("there is no stage \"" + stage + "\" to train");
  }
  const nlohmann::json description = stage_description(recipe, stage);
  result.config["recipe"] = {{"trainer", description["trainer"]},
                             {"training", description["training"]}};
  nn::save_model(file(stage), {result});
  fs::remove(checkpoint);
}

void join_stages(const TrainingRecipe& recipe, const StageFile& file, const TrainingSplits& clips,
                 const std::string& model_path, const Monitor& monitor) {
  std::vector<nn::ModelStage> stages;
  for (const std::string& name : recipe_stages(recipe)) {
    // A run that was killed between writing the stage and this left it.
    fs::remove(file(name) + ".checkpoint");
    nn::ModelStage stage = nn::load_stage(file(name), name);
    if (name == "masked" && generator::masked_config(stage.config).max_hits > 0) {
      const retriever::Retriever retriever = retriever::open_retriever(file("retriever"));
      const auto gate = training::measure_gate(retriever, clips.train, clips.val, monitor);
      if (gate) pipeline::set_stage_gate(stage, *gate);
    }
    stages.push_back(std::move(stage));
  }
  nn::save_model(model_path, stages, /*half=*/true);
}

}  // namespace remomask::training
