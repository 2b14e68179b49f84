#include "evaluation/retrieval_protocols.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include <cmath>

#include "evaluation/caption_similarity.h"
#include "evaluation/retrieval_metrics.h"
#include "remomask/error.h"

namespace remomask {
namespace {

/// 0 and 1 share a caption, 2 has their words in another order, 3 and 4 are
/// windows of one file.
std::vector<db::TrainingClip> five_clips() {
  const std::vector<std::string> captions = {
      "A person walks forward slowly.", "a person walks forward slowly",
      "slowly, a person walks forward", "someone jumps", "someone jumps twice in place"};
  std::vector<db::TrainingClip> clips(5);
  for (size_t i = 0; i < 5; ++i) {
    clips[i].name = "clip" + std::to_string(i);
    clips[i].group = std::min(3, static_cast<int>(i));
    clips[i].captions = {captions[i]};
  }
  return clips;
}

/// Text t is nearest to the motion 1, 2, 2, 4, 3, then to its own.
evaluation::EncodedSplit five_vectors(const std::vector<db::TrainingClip>& clips) {
  const at::Tensor nearest = torch::tensor({1, 2, 2, 4, 3}, torch::kLong);
  const at::Tensor text = 0.5f * torch::eye(5) + torch::eye(5).index_select(0, nearest);
  return {evaluation::caption_set(clips, false), text, torch::eye(5)};
}

TEST(CaptionSimilarity, ByHand) {
  const evaluation::CaptionSimilarity similarity({"walk, run!", "Walk jump.", "jump", ""});
  const double two = std::log(5. / 3) + 1, one = std::log(5. / 2) + 1;  // captions with the word
  const auto first = similarity.row(0), third = similarity.row(2), last = similarity.row(3);
  EXPECT_NEAR(first[0], 1, 1e-6);
  EXPECT_NEAR(first[1], two * two / (std::hypot(two, one) * std::sqrt(2.) * two), 1e-6);
  EXPECT_EQ(first[2], 0);
  EXPECT_NEAR(third[1], std::sqrt(0.5), 1e-6);
  EXPECT_EQ(last, (std::vector<float>{0, 0, 0, 0}));
}

TEST(RetrievalProtocols, NamesGoBothWays) {
  for (const evaluation::RetrievalProtocol protocol : evaluation::kRetrievalProtocols) {
    EXPECT_EQ(evaluation::parse_retrieval_protocol(evaluation::retrieval_protocol_name(protocol)),
              protocol);
  }
  EXPECT_THROW(evaluation::parse_retrieval_protocol("guo"), Error);
}

TEST(RetrievalProtocols, CorrectPairsByHand) {
  const auto clips = five_clips();
  const evaluation::CaptionSet captions = evaluation::caption_set(clips, false);
  const auto correct = [&](evaluation::RetrievalProtocol protocol) {
    std::vector<std::string> rows;
    const evaluation::ProtocolPlan plan = evaluation::protocol_plan(protocol, captions, clips);
    for (int64_t t = 0; t < 5; ++t) {
      std::string row;
      for (int64_t c = 0; c < 5; ++c) row += plan.correct[t][c].item<bool>() ? '1' : '0';
      rows.push_back(row);
    }
    return rows;
  };
  using Rows = std::vector<std::string>;
  EXPECT_EQ(correct(evaluation::RetrievalProtocol::all),
            (Rows{"10000", "01000", "00100", "00010", "00001"}));
  EXPECT_EQ(correct(evaluation::RetrievalProtocol::duplicates),
            (Rows{"11000", "11000", "00100", "00011", "00011"}));
  EXPECT_EQ(correct(evaluation::RetrievalProtocol::threshold),
            (Rows{"11100", "11100", "11100", "00010", "00001"}));
}

TEST(RetrievalProtocols, FiguresByHand) {
  const auto clips = five_clips();
  evaluation::RetrievalOptions options;
  options.settings.dissimilar = 2;
  options.settings.batch = 2;
  const evaluation::RetrievalEvaluation evaluation =
      evaluation::evaluate_encoded(five_vectors(clips), clips, options);
  const auto text_to_motion = [&](size_t protocol) {
    return evaluation.protocols.at(protocol).subsets.at(0).text_to_motion.recall;
  };
  ASSERT_EQ(evaluation.protocols.size(), 5u);
  // Text 2 alone finds its own clip first, the others second.
  EXPECT_DOUBLE_EQ(text_to_motion(0).recall[0], 20);
  EXPECT_DOUBLE_EQ(text_to_motion(0).recall[1], 100);
  EXPECT_DOUBLE_EQ(text_to_motion(0).median_rank, 2);
  EXPECT_DOUBLE_EQ(text_to_motion(1).recall[0], 60);  // threshold: texts 0, 1, 2
  // Dissimilar: clips 0 and 3, whose texts find themselves.
  EXPECT_DOUBLE_EQ(text_to_motion(2).recall[0], 100);
  EXPECT_EQ(text_to_motion(2).gallery, 2);
  EXPECT_EQ(text_to_motion(2).queries, 2);
  // Two galleries of two: a text fails when the clip that it prefers is there.
  const evaluation::ProtocolPlan batches =
      evaluation::protocol_plan(evaluation::RetrievalProtocol::small_batch,
                                evaluation::caption_set(clips, false), clips, options.settings);
  ASSERT_EQ(batches.galleries.size(), 2u);
  int failures = 0;
  const std::vector<size_t> prefers = {1, 2, 2, 4, 3};
  for (const auto& gallery : batches.galleries) {
    ASSERT_EQ(gallery.size(), 2u);
    for (size_t i = 0; i < 2; ++i) failures += prefers[gallery[i]] == gallery[1 - i];
  }
  EXPECT_DOUBLE_EQ(text_to_motion(3).recall[0], 100 * (1 - failures / 4.));
  EXPECT_EQ(text_to_motion(3).queries, 4);
  EXPECT_EQ(text_to_motion(3).gallery, 2);
  EXPECT_DOUBLE_EQ(text_to_motion(4).recall[0], 80);  // duplicates: all but text 1
  // The other way: motions 0 and 2 find their own texts first.
  const evaluation::RecallFigures back = evaluation.protocols[0].subsets[0].motion_to_text.recall;
  EXPECT_DOUBLE_EQ(back.recall[0], 40);
  EXPECT_EQ(back.queries, 5);
}

TEST(RetrievalProtocols, SmallBatchesArePartsOfTheSplitAndDependOnTheSeed) {
  std::vector<db::TrainingClip> clips(100);
  for (size_t i = 0; i < clips.size(); ++i) {
    clips[i].name = "clip" + std::to_string(i);
    clips[i].captions = {"number " + std::to_string(i)};
  }
  clips[7].captions.clear();
  const evaluation::CaptionSet captions = evaluation::caption_set(clips, false);
  const auto galleries = [&](uint64_t seed) {
    evaluation::ProtocolSettings settings;
    settings.seed = seed;
    return evaluation::protocol_plan(evaluation::RetrievalProtocol::small_batch, captions, clips,
                                     settings)
        .galleries;
  };
  const auto batches = galleries(0);
  ASSERT_EQ(batches.size(), 3u);  // 99 clips: the last 3 are left out
  std::vector<bool> seen(clips.size());
  for (const auto& batch : batches) {
    EXPECT_EQ(batch.size(), 32u);
    for (const size_t clip : batch) {
      EXPECT_FALSE(seen[clip]);
      EXPECT_NE(clip, 7u);
      seen[clip] = true;
    }
  }
  EXPECT_EQ(galleries(0), batches);
  EXPECT_NE(galleries(1), batches);
}

TEST(RetrievalProtocols, DissimilarClipsAreFarApartAndOneAGroup) {
  const auto clips = five_clips();
  const evaluation::CaptionSet captions = evaluation::caption_set(clips, false);
  EXPECT_EQ(evaluation::dissimilar_clips(captions, clips, 2), (std::vector<size_t>{0, 3}));
  EXPECT_EQ(evaluation::dissimilar_clips(captions, clips, 100), (std::vector<size_t>{0, 1, 2, 3}));
}

TEST(RetrievalProtocols, SeveralCaptionsShareTheirClip) {
  auto clips = five_clips();
  clips[0].captions.push_back("he strolls");
  const evaluation::CaptionSet captions = evaluation::caption_set(clips, true);
  EXPECT_EQ(captions.clips, (std::vector<size_t>{0, 0, 1, 2, 3, 4}));
  const evaluation::ProtocolPlan plan =
      evaluation::protocol_plan(evaluation::RetrievalProtocol::all, captions, clips);
  EXPECT_EQ(plan.correct.sum().item<int64_t>(), 6);
  EXPECT_TRUE(plan.correct[1][0].item<bool>());
}

TEST(RetrievalProtocols, SplitHashIsOfTheNamesInAnyOrder) {
  auto clips = five_clips();
  const std::string hash = evaluation::clip_set_hash(clips);
  std::swap(clips[0], clips[3]);
  EXPECT_EQ(evaluation::clip_set_hash(clips), hash);
  clips.pop_back();
  EXPECT_NE(evaluation::clip_set_hash(clips), hash);
}

}  // namespace
}  // namespace remomask
