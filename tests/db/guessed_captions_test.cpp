#include <gtest/gtest.h>

#include "db/check.h"
#include "db/database.h"
#include "db/training_set.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

class GuessedCaptionsTest : public ::testing::Test {
 protected:
  int64_t add(const std::string& name, const std::vector<std::string>& captions) {
    db::Clip clip = named_clip(name);
    clip.captions = captions;
    return database_.add_clip(clip, walking_motion(24, seed_++));
  }

  TestFolder folder_;
  std::string path_ = folder_ / "motions.sqlite";
  db::Database database_{path_, db::OpenMode::create};
  int seed_ = 0;
  const int64_t dumb_ = add("dumb", {}), told_ = add("told", {"a person walks"});
};

TEST_F(GuessedCaptionsTest, AreKeptApartFromThoseOfPeople) {
  const int64_t before = database_.generation();
  database_.store_guesses({{dumb_, "a person jogs", 0.7}, {dumb_, "someone runs", 0.4}});
  EXPECT_GT(database_.generation(), before);
  const auto guesses = database_.guessed_captions();
  ASSERT_EQ(guesses.size(), 2u);
  EXPECT_EQ(guesses[0].text, "a person jogs");
  EXPECT_DOUBLE_EQ(guesses[1].probability, 0.4);
  EXPECT_TRUE(database_.clip(dumb_).captions.empty());
  EXPECT_TRUE(database_.match_captions("jogs").empty());
  for (const db::TrainingClip& clip : db::load_training_set(database_)) {
    EXPECT_EQ(clip.captions.empty(), clip.clip_id == dumb_);
  }
  // They want a vector as the others do.
  EXPECT_EQ(database_.captions_without_vector("e"),
            (std::vector<std::string>{"a person jogs", "a person walks", "someone runs"}));
  database_.add_caption_vectors("e", {{"a person jogs", {1}}, {"gone", {1}}});
  EXPECT_EQ(database_.captions_without_vector("e"),
            (std::vector<std::string>{"a person walks", "someone runs"}));
  EXPECT_EQ(database_.drop_unused_caption_vectors("e"), 1);
  EXPECT_TRUE(db::check_database(path_).defects.empty());
}

TEST_F(GuessedCaptionsTest, GiveWayToPeopleAndGoWithTheirClip) {
  database_.store_guesses({{dumb_, "a person jogs", 0.7}});
  db::ClipChanges changes;
  changes.captions = {"a person hops"};
  database_.update_clip(dumb_, changes);
  EXPECT_TRUE(database_.guessed_captions().empty());
  const int64_t other = add("other", {});
  database_.store_guesses({{other, "a person jogs", 0.7}});
  database_.remove({other});
  EXPECT_TRUE(database_.guessed_captions().empty());
  const int64_t third = add("third", {});
  database_.store_guesses({{third, "a person jogs", 0.7}});
  EXPECT_EQ(database_.remove_guesses({third, dumb_}), 1);
  EXPECT_EQ(database_.remove_guesses({third}), 0);
}

TEST_F(GuessedCaptionsTest, RefusesWhatIsNoGuess) {
  EXPECT_NE(error_of([&] { database_.store_guesses({{told_, "a person jogs", 0.7}}); }), "");
  EXPECT_NE(error_of([&] { database_.store_guesses({{dumb_, "", 0.7}}); }), "");
  EXPECT_NE(error_of([&] {
              database_.store_guesses({{dumb_, "a person jogs", 0.5}, {dumb_, "hops", 1.0}});
            }),
            "");
  EXPECT_TRUE(database_.guessed_captions().empty());
}

}  // namespace
}  // namespace remomask
