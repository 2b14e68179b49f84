#include "db/training_set.h"

#include "motion/canonical.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

std::vector<std::string> names_of(const std::vector<db::TrainingClip>& clips) {
  std::vector<std::string> names;
  for (const db::TrainingClip& clip : clips) names.push_back(clip.name);
  return names;
}

TEST(TrainingSet, TwinsFollowTheirOriginals) {
  TestFolder folder;
  db::Database database(folder / "d", db::OpenMode::create);
  db::Clip clip = named_clip("a");
  clip.labels = {{"content", "walk-turn-left"}, {"style", "proud"}, {"unseen", "pair"}};
  const Motion motion = walking_motion(60, 1);
  const int64_t id = database.add_clip(clip, motion);
  database.add_clip(named_clip("b"), walking_motion(40, 2));

  const auto set = db::load_training_set(database);
  EXPECT_EQ(names_of(set), (std::vector<std::string>{"a", "Ma", "b", "Mb"}));
  EXPECT_EQ(set[1].clip_id, id);
  EXPECT_TRUE(set[1].mirrored);
  EXPECT_FALSE(set[0].mirrored);
  EXPECT_EQ(set[0].group, set[1].group);
  EXPECT_NE(set[0].group, set[2].group);
  EXPECT_EQ(set[0].captions[1], "someone is walking left.");
  EXPECT_EQ(set[1].captions[1], "someone is walking right.");
  EXPECT_EQ(set[0].content, "walk-turn-left");
  EXPECT_EQ(set[1].content, "walk-turn-right");
  EXPECT_EQ(set[0].meaning, "walk-turn-left/proud");
  EXPECT_EQ(set[1].meaning, "walk-turn-right/proud");
  EXPECT_EQ(set[2].meaning, "walk/");  // named_clip has the label "content" alone
  EXPECT_EQ(set[0].unseen, "pair");
  EXPECT_EQ(set[2].content, "walk");
  EXPECT_EQ(set[2].unseen, "");
  const Skeleton& skeleton = humanml_skeleton();
  EXPECT_EQ(
      set[0].features.values,
      motion::extract_features_all_frames(motion, skeleton, motion::FeatureMode::fixed).values);
  EXPECT_EQ(set[1].features.values,
            motion::extract_features_all_frames(motion::mirror_motion(motion, skeleton), skeleton,
                                                motion::FeatureMode::fixed)
                .values);
  EXPECT_EQ(set[0].features.frames, 60);
}

TEST(TrainingSet, NoTwinWhereTheMirrorIsStored) {
  TestFolder folder;
  db::Database database(folder / "d", db::OpenMode::create);
  db::Clip original = named_clip("012314"), mirrored = named_clip("M012314");
  mirrored.mirrored = true;
  mirrored.group = original.group;
  mirrored.split = "val";
  db::Clip lonely = named_clip("M000001");
  lonely.mirrored = true;
  lonely.labels = nlohmann::json::object();
  database.add_clip(original, walking_motion(30, 1));
  database.add_clip(mirrored, walking_motion(30, 2));
  database.add_clip(lonely, walking_motion(30, 3));
  const auto train = db::load_training_set(database);
  EXPECT_EQ(names_of(train), (std::vector<std::string>{"012314", "M000001", "000001"}));
  EXPECT_FALSE(train[2].mirrored);
  EXPECT_EQ(train[2].content, "");
  db::TrainingSetOptions options;
  options.splits = {"val"};
  const auto val = db::load_training_set(database, options);
  EXPECT_EQ(names_of(val), (std::vector<std::string>{"M012314"}));
  // The same number in every split.
  EXPECT_EQ(val[0].group, train[0].group);
}

TEST(TrainingSet, LengthsSplitsAndModeAreHonoured) {
  TestFolder folder;
  db::Database database(folder / "d", db::OpenMode::create);
  db::Clip test = named_clip("test");
  test.split = "test";
  database.add_clip(named_clip("short"), walking_motion(19, 1));
  const Motion motion = walking_motion(200, 2);
  database.add_clip(named_clip("long"), motion);
  database.add_clip(test, walking_motion(30, 3));
  db::TrainingSetOptions options;
  options.add_mirrored = false;
  options.mode = motion::FeatureMode::official;
  const auto set = db::load_training_set(database, options);
  EXPECT_EQ(names_of(set), (std::vector<std::string>{"long"}));
  EXPECT_EQ(set[0].features.frames, 196);
  EXPECT_EQ(set[0].features.values,
            motion::extract_features_all_frames(slice(motion, 0, 196), humanml_skeleton(),
                                                motion::FeatureMode::official)
                .values);
  options.splits = {"train", "test"};
  EXPECT_EQ(db::load_training_set(database, options).size(), 2u);
  options.min_frames = 0;
  EXPECT_THROW(db::load_training_set(database, options), Error);
}

TEST(TrainingSet, MixedSkeletonsAndBrokenMotionsAreNamed) {
  TestFolder folder;
  db::Database database(folder / "d", db::OpenMode::create);
  db::Clip broken = named_clip("broken");
  broken.content_hash = "given";
  Motion motion = walking_motion(30, 1);
  motion.positions[100] = std::numeric_limits<float>::infinity();
  database.add_clip(broken, motion);
  EXPECT_NE(error_of([&] { db::load_training_set(database); }).find("clip 'broken'"),
            std::string::npos);
  database.remove_clips("test", "broken");
  database.add_clip(named_clip("a"), walking_motion(30, 2));
  db::Clip kit = named_clip("k");
  kit.skeleton = "kit";
  database.add_clip(kit, Motion(30, 21));
  EXPECT_NE(error_of([&] { db::load_training_set(database); }).find("different skeletons"),
            std::string::npos);
}

}  // namespace
}  // namespace remomask
