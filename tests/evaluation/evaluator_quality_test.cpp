#include "evaluation/evaluator_quality.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include <cmath>

#include "base/error.h"
#include "evaluation/reconstruction_fid.h"
#include "generator/tokenizer_metrics.h"
#include "generator/tokenizer_network.h"
#include "tests/evaluation/evaluator_test_tools.h"
#include "tests/generator/tokenizer_test_tools.h"
#include "tests/retriever/retriever_test_tools.h"

namespace remomask {
namespace {

TEST(BatchKeys, CaptionsAndLabels) {
  TrainingClip clip;
  clip.group = 7;
  EXPECT_EQ(batch_keys(clip, "A run.", DistinctBy::captions), (BatchKeys{"caption a run"}));
  EXPECT_EQ(batch_keys(clip, "a", DistinctBy::labels).at(1), "group 7");
  clip.content = "run";
  EXPECT_EQ(batch_keys(clip, "a", DistinctBy::labels).at(1), "content run");
  clip.meaning = "run/proud";
  EXPECT_EQ(batch_keys(clip, "a", DistinctBy::labels).at(1), "meaning run/proud");
}

TEST(NearestContents, FindTwinsButNotTheOwnGroup) {
  const Evaluator evaluator(untrained_evaluator_stage(2));
  auto clips = separable_clips(3, 2, 1);
  const char* contents[] = {"a", "a", "b", "b", "c", ""};
  for (size_t i = 0; i < clips.size(); ++i) clips[i].content = contents[i];
  // A gallery with an exact copy of each clip, of another group and the same content.
  auto gallery = clips;
  for (TrainingClip& clip : gallery) clip.group += 100;
  EXPECT_EQ(nearest_contents(evaluator, clips, gallery), (std::vector<int>{1, 1, 1, 1, 1, -1}));
  // Copies that say something else.
  for (TrainingClip& clip : gallery) {
    if (!clip.content.empty()) clip.content = "other";
  }
  EXPECT_EQ(nearest_contents(evaluator, clips, gallery), (std::vector<int>{0, 0, 0, 0, 0, -1}));
  // Of the own group: never found.
  EXPECT_THROW(nearest_contents(evaluator, {clips[0]}, {clips[0]}), Error);
  const ContentAccuracy accuracy =
      content_accuracy({1, 0, -1, 1, 1}, {true, true, true, true, false});
  EXPECT_EQ(accuracy.motions, 3);
  EXPECT_EQ(accuracy.right, 2);
  EXPECT_NEAR(accuracy.standard_error, std::sqrt(2. / 27), 1e-12);
}

TEST(EvaluatorQuality, SubsetsAndRealPairs) {
  const Evaluator evaluator(untrained_evaluator_stage(2));
  auto train = separable_clips(4, 30, 1), clips = separable_clips(4, 4, 2);
  for (auto* set : {&train, &clips}) {
    for (TrainingClip& clip : *set) clip.content = clip.captions[0];
  }
  for (TrainingClip& clip : train) clip.group += 1000;
  clips[0].unseen = "pair";
  clips[1].content = "seldom";
  clips[2].captions.clear();
  GenerationFigureOptions options;
  options.batch = 4;
  options.draws = 2;
  const EvaluatorQuality quality = measure_evaluator(evaluator, clips, train, {}, options);
  ASSERT_EQ(quality.subsets.size(), 3u);
  EXPECT_EQ(quality.subsets[0].captions.motions, 15);
  EXPECT_EQ(quality.subsets[0].captions.fid.mean, 0);
  EXPECT_EQ(quality.subsets[1].name, "pair");
  EXPECT_EQ(quality.subsets[1].captions.motions, 1);
  EXPECT_EQ(quality.subsets[2].name, "rare");
  EXPECT_EQ(quality.subsets[2].content.right, 0);
  EXPECT_GT(quality.fid_to_train, 0);
  const auto runs = real_pairs(evaluator, {train[0]}, DistinctBy::captions, 2, 1);
  EXPECT_TRUE(runs[0].text.equal(evaluator.embed_text(train[0].captions)));
}

TEST(ReconstructionFid, OfAnUntrainedTokenizerIsLarge) {
  torch::manual_seed(1);
  TokenizerNetwork network(small_tokenizer_config());
  const Tokenizer tokenizer({"tokenizer", small_tokenizer_config(), module_tensors(*network)});
  const auto clips = swinging_clips({40, 31, 24, 60, 52, 3});
  const Evaluator evaluator(untrained_evaluator_stage(2));
  const ReconstructionFid fid =
      measure_reconstruction_fid(evaluator, tokenizer, clip_features(clips));
  EXPECT_GT(fid.all_levels, 0);
  EXPECT_TRUE(std::isfinite(fid.base_level));
  EXPECT_THROW(measure_reconstruction_fid(evaluator, tokenizer, {&clips[0].features}), Error);
}

}  // namespace
}  // namespace remomask
