#include "search/describe.h"

#include <gtest/gtest.h>

#include "remomask/error.h"
#include "tests/db/db_test_tools.h"
#include "tests/index/index_test_tools.h"

namespace remomask {
namespace {

constexpr int kKinds = 5, kOfEach = 12;

/// Clips of five kinds whose motions and captions lie around one direction a kind each; the last of
/// every kind has no caption.
class DescribeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::vector<std::string> kinds = {"walk", "kick", "wave", "sit", "jump"};
    const auto centres = random_directions(kKinds, 32, 1);
    std::vector<db::ClipEmbedding> embeddings;
    std::vector<db::CaptionVector> vectors;
    for (int i = 0; i < kKinds * kOfEach; ++i) {
      const int kind = i % kKinds;
      db::Clip clip = named_clip(kinds[static_cast<size_t>(kind)] + std::to_string(i));
      clip.labels = {{"actions", {kinds[static_cast<size_t>(kind)]}}};
      clip.captions.clear();
      const bool dumb = i >= kKinds * (kOfEach - 1);
      if (!dumb) {
        clip.captions = {"a person does " + kinds[static_cast<size_t>(kind)] + " number " +
                         std::to_string(i)};
        vectors.push_back({clip.captions.front(), near(centres, kind, 500 + i)});
      }
      const int64_t id = database_.add_clip(clip, walking_motion(8, i));
      embeddings.push_back({id, near(centres, kind, i), {}, {}});
      if (dumb) dumb_.push_back(id);
    }
    database_.store_embeddings("r", embeddings);
    database_.add_caption_vectors("e", vectors);
  }

  static std::vector<float> near(const std::vector<float>& centres, int kind, int seed) {
    std::vector<float> vector = random_directions(1, 32, static_cast<uint64_t>(seed) + 10);
    double square = 0;
    for (size_t i = 0; i < 32; ++i) {
      vector[i] = centres[static_cast<size_t>(kind) * 32 + i] + 0.3f * vector[i];
      square += static_cast<double>(vector[i]) * vector[i];
    }
    for (float& value : vector) value /= static_cast<float>(std::sqrt(square));
    return vector;
  }

  TestFolder folder_;
  db::Database database_{folder_ / "d", db::OpenMode::create};
  std::vector<int64_t> dumb_;
};

TEST_F(DescribeTest, TakesTheWordsOfClipsThatMoveAlike) {
  const search::Descriptions made = search::describe_clips(database_, "r", "e", dumb_, {});
  EXPECT_EQ(made.undescribed, 0);
  EXPECT_EQ(made.learnt_from, kKinds * (kOfEach - 1));
  EXPECT_GT(made.share_right, 0.95);
  ASSERT_FALSE(made.guesses.empty());
  for (const db::GuessedCaption& guess : made.guesses) {
    const std::string action = database_.clip(guess.clip_id).labels["actions"][0];
    EXPECT_NE(guess.text.find(action), std::string::npos) << guess.text;
    EXPECT_GT(guess.probability, 0.5);
    EXPECT_LT(guess.probability, 1);
  }
  database_.store_guesses(made.guesses);
  EXPECT_EQ(database_.remove_guesses(dumb_), kKinds);
}

TEST_F(DescribeTest, SaysNothingRatherThanNonsense) {
  // Motions that tell nothing: neighbours are of any kind.
  std::vector<db::ClipEmbedding> embeddings = database_.embeddings("r");
  for (db::ClipEmbedding& one : embeddings) {
    one.motion = random_directions(1, 32, static_cast<uint64_t>(one.clip_id) + 900);
  }
  database_.store_embeddings("random", embeddings);
  search::DescribeOptions options;
  options.min_probability = 0.8;
  const auto made = search::describe_clips(database_, "random", "e", dumb_, options);
  EXPECT_LT(made.share_right, 0.6);
  EXPECT_GE(made.undescribed, 4);
}

TEST_F(DescribeTest, NeedsDescribedClips) {
  EXPECT_NE(error_of([&] { search::describe_clips(database_, "other", "e", dumb_, {}); }), "");
  EXPECT_NE(error_of([&] { search::describe_clips(database_, "r", "other", dumb_, {}); }), "");
  std::stop_source stop;
  stop.request_stop();
  Monitor monitor;
  monitor.stop = stop.get_token();
  EXPECT_THROW(search::describe_clips(database_, "r", "e", dumb_, {}, monitor), Interrupted);
}

}  // namespace
}  // namespace remomask
