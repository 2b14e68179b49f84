#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "db/database.h"
#include "encoders/sentence_encoder.h"
#include "remomask/library.h"
#include "tools/train_command.h"
#include "training/words_training.h"

namespace remomask::tools {

void run_train_words(const TrainCommand& command, Program& program) {
  namespace fs = std::filesystem;
  const std::string source =
      command.text_file.empty() ? shipped_file("text.safetensors") : command.text_file;
  const nn::ModelStage text = nn::load_stage(source, encoders::kTextEncoderStage);
  std::vector<db::Clip> clips = db::Database(command.database, db::OpenMode::read_only).clips();
  std::erase_if(clips, [&](const db::Clip& clip) {
    return !command.sources.empty() && std::find(command.sources.begin(), command.sources.end(),
                                                 clip.source) == command.sources.end();
  });
  fs::create_directories(command.folder);
  const std::string path = (fs::path(command.folder) / "text.safetensors").string();
  training::WordsTrainingOptions options;
  training::TrainerOptions& trainer = options.trainer;
  trainer.steps = command.steps.value_or(trainer.steps);
  trainer.learning_rate = command.learning_rate.value_or(trainer.learning_rate);
  trainer.warmup_steps = std::min(trainer.warmup_steps, std::max<int64_t>(1, trainer.steps / 10));
  trainer.seed = command.seed;
  trainer.checkpoint_path = (fs::path(command.folder) / "words.checkpoint").string();
  options.batch = command.batch.value_or(options.batch);
  const nn::ModelStage adapter =
      training::train_words(text, training::caption_classes(clips, "train"),
                            training::caption_classes(clips, "val"), options, program.monitor());
  // Without the score of search: it belongs to the encoder as it was.
  nn::save_model(path, {text, adapter}, /*half=*/true);
  fs::remove(trainer.checkpoint_path);
  program.finish_progress();
  if (program.json) return program.print_json({{"file", path}});
  fmt::print("{}\nfit its score: remomask index DB --text {}; remomask evaluate search --fit\n",
             path, path);
}

}  // namespace remomask::tools
