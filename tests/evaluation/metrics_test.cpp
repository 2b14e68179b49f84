#include <gtest/gtest.h>
#include <torch/utils.h>

#include "evaluation/retrieval_metrics.h"
#include "tests/retriever/retriever_test_tools.h"

namespace remomask {
namespace {

TEST(RetrievalMetrics, RanksByHand) {
  const auto similarity = torch::tensor({0.9f, 0.8f, 0.7f, 0.1f,   // best correct is third
                                         0.5f, 0.5f, 0.5f, 0.2f,   // two wrong ties
                                         0.1f, 0.2f, 0.3f, 0.4f,   // first
                                         0.4f, 0.3f, 0.2f, 0.1f})  // two correct: better counts
                              .view({4, 4});
  const auto correct = torch::tensor({0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 1}, torch::kInt)
                           .view({4, 4})
                           .to(torch::kBool);
  EXPECT_EQ(evaluation::best_ranks(similarity, correct), (std::vector<double>{3, 2, 1, 2}));
}

TEST(RetrievalMetrics, RecallAndMedianByHand) {
  const evaluation::RecallFigures figures =
      evaluation::recall_figures({1, 1.5, 2, 4, 11, 6}, {6}, 20, {});
  EXPECT_DOUBLE_EQ(figures.recall[0], 100.0 / 6);      // 1
  EXPECT_DOUBLE_EQ(figures.recall[1], 100.0 * 3 / 6);  // 1, 1.5, 2
  EXPECT_DOUBLE_EQ(figures.recall[2], 100.0 * 3 / 6);
  EXPECT_DOUBLE_EQ(figures.recall[3], 100.0 * 4 / 6);
  EXPECT_DOUBLE_EQ(figures.recall[4], 100.0 * 5 / 6);
  EXPECT_DOUBLE_EQ(figures.median_rank, 3);
  EXPECT_EQ(figures.queries, 6);
  EXPECT_EQ(figures.gallery, 20);
  ASSERT_EQ(figures.intervals.size(), evaluation::kRecallRanks.size() + 1);
  EXPECT_LT(figures.intervals[1].low, 50);
  EXPECT_GT(figures.intervals[1].high, 50);
  EXPECT_TRUE(evaluation::recall_figures({1}, {1}, 20, {0, 0.95, 0}).intervals.empty());
}

TEST(RetrievalMetrics, MediansOfSeveralGalleriesAreAveraged) {
  const evaluation::RecallFigures figures =
      evaluation::recall_figures({1, 3, 4, 1, 1}, {2, 0, 3}, 7, {});
  EXPECT_DOUBLE_EQ(figures.recall[0], 60);
  EXPECT_DOUBLE_EQ(figures.median_rank, (2 * 2. + 3 * 1.) / 5);
}

TEST(RetrievalMetrics, ConstantSimilarityIsChance) {
  const auto ranks = evaluation::best_ranks(torch::zeros({5, 5}), torch::eye(5).to(torch::kBool));
  for (const double rank : ranks) EXPECT_DOUBLE_EQ(rank, 3);
}

TEST(RetrievalMetrics, LabelsOfTheFirstHitByHand) {
  std::vector<db::TrainingClip> clips(4);
  const std::vector<std::string> contents = {"walk", "walk", "run", "jump"};
  for (size_t i = 0; i < 4; ++i) clips[i].content = contents[i];
  clips[0].meaning = "walk/proud";
  clips[1].meaning = "walk/tired";
  clips[2].meaning = "run/";
  // Clip 3 has no labels: as a query it does not count, as an answer it is wrong.
  const evaluation::LabelFigures figures = evaluation::label_figures(
      {{0, 1, 1, 1}, {1, 1, 4, 1}, {2, 2, 4, 2}, {2, 3, 12, 1}, {3, 3, 1, 1}}, clips);
  EXPECT_EQ(figures.queries, 4);
  EXPECT_DOUBLE_EQ(figures.content, 75);
  EXPECT_DOUBLE_EQ(figures.meaning, 50);
  EXPECT_NEAR(figures.perfect_recall[0], 100 * (1 + 1. / 4 + 1. / 2 + 1. / 12) / 4, 1e-9);
  // Two of four within two of them: 1 - 2/4 x 1/3.
  EXPECT_NEAR(figures.perfect_recall[1], 100 * (1 + 2. / 4 + 5. / 6 + 2. / 12) / 4, 1e-9);
  EXPECT_NEAR(figures.perfect_recall[4], 100 * (3 + 10. / 12) / 4, 1e-9);
  EXPECT_EQ(evaluation::label_figures({{3, 3, 1, 1}}, clips).queries, 0);
}

TEST(RetrievalMetrics, SameCaptionAndSameGroupAreCorrectAndSubsetsKeepTheGallery) {
  std::vector<db::TrainingClip> clips(4);
  const std::vector<std::string> captions = {"A man walks.", "a man walks", "she jumps", "he runs"};
  for (size_t i = 0; i < 4; ++i) {
    clips[i].group = i == 3 ? 2 : static_cast<int>(i);
    clips[i].captions = {captions[i]};
    clips[i].unseen = i < 2 ? "take" : "pair";
  }
  // Text i is nearest to motion i + 1 (mod 4): right for 0 and 2 alone.
  evaluation::RetrievalOptions options;
  options.protocols = {evaluation::RetrievalProtocol::duplicates};
  const auto evaluation = evaluation::evaluate_encoded(
      {evaluation::caption_set(clips, false), torch::eye(4), torch::eye(4).roll(1, 0)}, clips,
      options);
  const auto& subsets = evaluation.protocols.at(0).subsets;
  ASSERT_EQ(subsets.size(), 3u);
  EXPECT_EQ(subsets[0].name, "all");
  EXPECT_DOUBLE_EQ(subsets[0].text_to_motion.recall.recall[0], 50);
  EXPECT_EQ(subsets[1].name, "take");
  EXPECT_EQ(subsets[1].text_to_motion.recall.queries, 2);
  EXPECT_EQ(subsets[1].text_to_motion.recall.gallery, 4);
  EXPECT_EQ(subsets[2].motion_to_text.recall.queries, 2);
}

}  // namespace
}  // namespace remomask
