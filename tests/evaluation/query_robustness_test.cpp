#include "evaluation/query_robustness.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include "tests/retriever/retriever_test_tools.h"

namespace remomask {
namespace {

TEST(QueryRobustness, FormsByHand) {
  const std::string caption = "A person is walking, then the dog's gone.";
  EXPECT_EQ(evaluation::write_query(caption, evaluation::QueryForm::as_written), caption);
  EXPECT_EQ(evaluation::write_query("he runs.", evaluation::QueryForm::upper_case), "HE RUNS.");
  EXPECT_EQ(evaluation::write_query("he runs.", evaluation::QueryForm::exclaimed), "he runs!");
  EXPECT_EQ(evaluation::write_query("walk, turn.", evaluation::QueryForm::no_punctuation),
            "walk turn");
  EXPECT_EQ(evaluation::write_query("A man lifts the leg", evaluation::QueryForm::no_articles),
            "man lifts leg");
  EXPECT_EQ(evaluation::write_query("A person is walking", evaluation::QueryForm::no_subject),
            "walking");
  EXPECT_EQ(evaluation::write_query("someone walks", evaluation::QueryForm::no_subject), "walks");
  EXPECT_EQ(evaluation::write_query("walk the person", evaluation::QueryForm::no_subject),
            "walk the person");
  EXPECT_EQ(evaluation::write_query("the", evaluation::QueryForm::no_articles), "the");
}

TEST(QueryRobustness, RerankingKeepsTheRestBehind) {
  const auto similarity = torch::tensor({0.9f, 0.8f, 0.7f, 0.6f}).view({1, 4});
  const auto parts = torch::tensor({-1.f, 0.f, 0.5f, 1.f}).view({1, 4});
  const auto order = [&](double weight) {
    const at::Tensor sorted = evaluation::rerank(similarity, parts, weight, 3).argsort(1, true);
    return std::vector<int64_t>(sorted.data_ptr<int64_t>(), sorted.data_ptr<int64_t>() + 4);
  };
  EXPECT_EQ(order(0), (std::vector<int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(order(0.15), (std::vector<int64_t>{1, 2, 0, 3}));  // 0.75, 0.8, 0.775, behind
  EXPECT_EQ(order(1), (std::vector<int64_t>{2, 1, 0, 3}));     // -0.1, 0.8, 1.2, behind
}

TEST(QueryRobustness, OverlapByHand) {
  const auto one = torch::tensor({4.f, 3.f, 2.f, 1.f, 1.f, 2.f, 3.f, 4.f}).view({2, 4});
  const auto two = torch::tensor({1.f, 3.f, 4.f, 2.f, 1.f, 2.f, 3.f, 4.f}).view({2, 4});
  EXPECT_DOUBLE_EQ(evaluation::best_overlap(one, two, 2), 75);  // {0, 1} and {2, 1}; both {2, 3}
  EXPECT_DOUBLE_EQ(evaluation::best_overlap(one, two, 9), 100);
}

TEST(QueryRobustness, CaseAndFinalMarksChangeNothing) {
  const retriever::Retriever retriever = untrained_retriever(1);
  auto clips = separable_clips(6, 2, 1);
  for (db::TrainingClip& clip : clips) clip.captions.push_back("another " + clip.captions[0]);
  const evaluation::QueryRobustness result =
      evaluation::measure_query_robustness(retriever, clips, {0, 0.95, 0});
  ASSERT_EQ(result.forms.size(), std::size(evaluation::kQueryForms));
  for (size_t form = 0; form < 3; ++form) {
    EXPECT_NEAR(result.forms[form].overlap, 100, 1e-9) << result.forms[form].name;
    EXPECT_EQ(result.forms[form].recall.recall, result.forms[0].recall.recall);
    EXPECT_EQ(result.forms[form].recall.queries, 24);
  }
  ASSERT_EQ(result.paraphrases.size(), 2u);
  EXPECT_EQ(result.paraphrases[1].recall.queries, 12);
  EXPECT_DOUBLE_EQ(result.paraphrases[0].overlap, 100);
  EXPECT_EQ(result.reranked[0].recall.recall, result.forms[0].recall.recall);
}

}  // namespace
}  // namespace remomask
