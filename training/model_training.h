#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "training/generator_data.h"
#include "training/training_recipe.h"

namespace remomask::training {

/// The clips that models are trained and validated on.
struct TrainingSplits {
  std::vector<db::TrainingClip> train, val;
};

/// Reads the splits "train" (with mirror twins) and "val" of a database; `sources`: only these
/// data sets, all if empty. Throws FileError if a split has no clips.
TrainingSplits load_splits(const std::string& database_path,
                           const std::vector<std::string>& sources = {});

/// Keeps what prepare_generator_data() made of the last pair of tokenizer and
/// retriever: several transformers may be trained on it.
class GeneratorDataCache {
 public:
  const GeneratorData& get(const std::string& tokenizer_file, const std::string& retriever_file,
                           const TrainingSplits& clips, const Monitor& monitor);

 private:
  std::string files_;
  std::optional<GeneratorData> data_;
};

/// File of a stage ("retriever", "tokenizer", ...).
using StageFile = std::function<std::string(const std::string& stage)>;

/// Trains one stage of a recipe and writes its file; reads the files of the stages it builds on,
/// and the sentence encoder beside them (encoders::text_file_of()). Its config holds under "recipe"
/// how it was trained. The checkpoint beside the file lets a stopped run go on. Throws Interrupted
/// when asked to stop, Error for what the training refuses.
void train_stage(const TrainingRecipe& recipe, const std::string& stage, const StageFile& file,
                 const TrainingSplits& clips, GeneratorDataCache& prepared, const Monitor& monitor);

/// Puts the stages of a recipe into one model file in half precision, with the
/// evidence gate of its retriever (measure_gate()) where it reads hits.
void join_stages(const TrainingRecipe& recipe, const StageFile& file, const TrainingSplits& clips,
                 const std::string& model_path, const Monitor& monitor);

}  // namespace remomask::training
