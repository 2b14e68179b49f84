#include "evaluation/evaluator_quality.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include <cmath>

#include "evaluation/reconstruction_fid.h"
#include "evaluation/tokenizer_metrics.h"
#include "remomask/error.h"
#include "tests/evaluation/evaluator_test_tools.h"
#include "tests/retriever/retriever_test_tools.h"
#include "tests/tokenizer/tokenizer_test_tools.h"
#include "tokenizer/tokenizer_network.h"

namespace remomask {
namespace {

TEST(BatchKeys, CaptionsAndLabels) {
  db::TrainingClip clip;
  clip.group = 7;
  EXPECT_EQ(evaluation::batch_keys(clip, "A run.", evaluation::DistinctBy::captions),
            (evaluation::BatchKeys{"caption a run"}));
  EXPECT_EQ(evaluation::batch_keys(clip, "a", evaluation::DistinctBy::labels).at(1), "group 7");
  clip.content = "run";
  EXPECT_EQ(evaluation::batch_keys(clip, "a", evaluation::DistinctBy::labels).at(1), "content run");
  clip.meaning = "run/proud";
  EXPECT_EQ(evaluation::batch_keys(clip, "a", evaluation::DistinctBy::labels).at(1),
            "meaning run/proud");
}

TEST(NearestContents, FindTwinsButNotTheOwnGroup) {
  const evaluation::Evaluator evaluator(untrained_evaluator_stage(2));
  auto clips = separable_clips(3, 2, 1);
  const char* contents[] = {"a", "a", "b", "b", "c", ""};
  for (size_t i = 0; i < clips.size(); ++i) clips[i].content = contents[i];
  // A gallery with an exact copy of each clip, of another group and the same content.
  auto gallery = clips;
  for (db::TrainingClip& clip : gallery) clip.group += 100;
  EXPECT_EQ(evaluation::nearest_contents(evaluator, clips, gallery),
            (std::vector<int>{1, 1, 1, 1, 1, -1}));
  // Copies that say something else.
  for (db::TrainingClip& clip : gallery) {
    if (!clip.content.empty()) clip.content = "other";
  }
  EXPECT_EQ(evaluation::nearest_contents(evaluator, clips, gallery),
            (std::vector<int>{0, 0, 0, 0, 0, -1}));
  // Of the own group: never found.
  EXPECT_THROW(evaluation::nearest_contents(evaluator, {clips[0]}, {clips[0]}), Error);
  const evaluation::ContentAccuracy accuracy =
      evaluation::content_accuracy({1, 0, -1, 1, 1}, {true, true, true, true, false});
  EXPECT_EQ(accuracy.motions, 3);
  EXPECT_EQ(accuracy.right, 2);
  EXPECT_NEAR(accuracy.standard_error, std::sqrt(2. / 27), 1e-12);
}

TEST(EvaluatorQuality, SubsetsAndRealPairs) {
  const evaluation::Evaluator evaluator(untrained_evaluator_stage(2));
  auto train = separable_clips(4, 30, 1), clips = separable_clips(4, 4, 2);
  for (auto* set : {&train, &clips}) {
    for (db::TrainingClip& clip : *set) clip.content = clip.captions[0];
  }
  for (db::TrainingClip& clip : train) clip.group += 1000;
  clips[0].unseen = "pair";
  clips[1].content = "seldom";
  clips[2].captions.clear();
  evaluation::GenerationFigureOptions options;
  options.batch = 4;
  options.draws = 2;
  const evaluation::EvaluatorQuality quality =
      measure_evaluator(evaluator, clips, train, {}, options);
  ASSERT_EQ(quality.subsets.size(), 3u);
  EXPECT_EQ(quality.subsets[0].captions.motions, 15);
  EXPECT_EQ(quality.subsets[0].captions.fid.mean, 0);
  EXPECT_EQ(quality.subsets[1].name, "pair");
  EXPECT_EQ(quality.subsets[1].captions.motions, 1);
  EXPECT_EQ(quality.subsets[2].name, "rare");
  EXPECT_EQ(quality.subsets[2].content.right, 0);
  EXPECT_GT(quality.fid_to_train, 0);
  const auto runs =
      evaluation::real_pairs(evaluator, {train[0]}, evaluation::DistinctBy::captions, 2, 1);
  EXPECT_TRUE(runs[0].text.equal(evaluator.embed_text(train[0].captions)));
}

TEST(ReconstructionFid, OfAnUntrainedTokenizerIsLarge) {
  torch::manual_seed(1);
  tokenizer::TokenizerNetwork network(small_tokenizer_config());
  const tokenizer::Tokenizer tokenizer(
      {"tokenizer", small_tokenizer_config(), nn::module_tensors(*network)});
  const auto clips = swinging_clips({40, 31, 24, 60, 52, 3});
  const evaluation::Evaluator evaluator(untrained_evaluator_stage(2));
  const evaluation::ReconstructionFid fid =
      measure_reconstruction_fid(evaluator, tokenizer, evaluation::clip_features(clips));
  EXPECT_GT(fid.all_levels, 0);
  EXPECT_TRUE(std::isfinite(fid.base_level));
  EXPECT_THROW(measure_reconstruction_fid(evaluator, tokenizer, {&clips[0].features}), Error);
}

}  // namespace
}  // namespace remomask
