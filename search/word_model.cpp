#include "search/word_model.h"

#include "nn/model_file.h"
#include "remomask/error.h"

namespace remomask::search {

namespace {

constexpr const char* kScoreStage = "text-score";

std::optional<WordScore> read_score(const nn::ModelStage& stage, const std::string& path,
                                    DamagedScore damaged) {
  try {
    return stage.config.get<WordScore>();
  } catch (const nlohmann::json::exception& error) {
    if (damaged == DamagedScore::is_none) return std::nullopt;
    throw FileError(path, 0,
                    std::string("its search score is damaged: ") + error.what() +
                        "; fit it again: remomask evaluate search --fit");
  }
}

}  // namespace

WordModel WordModel::open(const std::string& path, DamagedScore damaged) {
  WordModel model;
  model.encoder =
      std::make_shared<const encoders::SentenceEncoder>(encoders::SentenceEncoder::open(path));
  if (nn::has_stage(path, kScoreStage)) {
    model.score = read_score(nn::load_stage(path, kScoreStage), path, damaged);
  }
  return model;
}

void store_word_score(const std::string& path, const WordScore& score) {
  std::vector<nn::ModelStage> stages;
  for (auto& [kind, stage] : nn::load_model(path)) {
    if (kind != kScoreStage) stages.push_back(std::move(stage));
  }
  stages.push_back({kScoreStage, score, {}});
  nn::save_model(path, stages, true);
}

}  // namespace remomask::search
