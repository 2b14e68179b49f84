#include "search/word_model.h"

#include <gtest/gtest.h>

#include "remomask/error.h"
#include "tests/base/test_folder.h"
#include "tests/encoders/tiny_encoder.h"

namespace remomask {
namespace {

TEST(WordModelTest, ADamagedScoreIsRefusedUnlessItIsToBeReplaced) {
  const TestFolder folder;
  const std::string path = folder / "text.safetensors";
  const nn::ModelStage text = tiny_encoder_stage({"walk"});
  nn::save_model(path, {text, {"text-score", {{"best", "high"}}, {}}}, true);
  EXPECT_THROW(search::WordModel::open(path), FileError);
  EXPECT_FALSE(search::WordModel::open(path, search::DamagedScore::is_none).score);
  search::WordScore score;
  score.best = 3;
  search::store_word_score(path, score);
  const search::WordModel model = search::WordModel::open(path);
  ASSERT_TRUE(model.score);
  EXPECT_DOUBLE_EQ(model.score->best, 3);
}

}  // namespace
}  // namespace remomask
