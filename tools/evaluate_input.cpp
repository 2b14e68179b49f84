#include "tools/evaluate_input.h"

#include "db/database.h"
#include "evaluation/retrieval_metrics.h"
#include "remomask/error.h"

namespace remomask::tools {

std::vector<db::TrainingClip> load_clips(const EvaluationInput& input, const std::string& split,
                                         motion::FeatureMode mode) {
  const std::string path = input.files.database_path();
  const db::Database database(path, db::OpenMode::read_only);
  db::TrainingSetOptions options;
  options.splits = {split};
  options.add_mirrored = false;
  options.sources = input.sources;
  options.mode = mode;
  auto clips = db::load_training_set(database, options);
  if (clips.empty()) {
    throw FileError(
        path, 0, "has no clips of split \"" + split + "\"; choose another --split or import clips");
  }
  return clips;
}

nlohmann::json stamped(const EvaluationInput& input, nlohmann::json document,
                       const std::vector<db::TrainingClip>& clips) {
  document["model"] = input.files.model_path();
  document["split"] = input.split;
  document["split_hash"] = evaluation::clip_set_hash(clips);
  return document;
}

}  // namespace remomask::tools
