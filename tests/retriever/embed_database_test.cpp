#include "retriever/embed_database.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include "tests/db/db_test_tools.h"
#include "tests/retriever/retriever_test_tools.h"

namespace remomask {
namespace {

TEST(EmbedDatabase, StoresEveryClipOnceForEachRetriever) {
  const TestFolder folder;
  db::Database database(folder / "a.sqlite", db::OpenMode::create);
  database.add_clip(named_clip("one"), walking_motion(30, 1));
  db::Clip silent = named_clip("two");
  silent.captions.clear();
  silent.split = "none";
  database.add_clip(silent, walking_motion(200, 2));

  const retriever::Retriever retriever = untrained_retriever(1);
  EXPECT_EQ(retriever::embed_database(database, retriever), 2);
  EXPECT_EQ(retriever::embed_database(database, retriever), 0);
  const auto stored = database.embeddings(retriever.hash());
  ASSERT_EQ(stored.size(), 2u);
  ASSERT_EQ(stored[0].motion.size(), static_cast<size_t>(retriever.embedding_width()));
  ASSERT_EQ(stored[0].parts.size(), static_cast<size_t>(6 * retriever.part_width()));
  EXPECT_TRUE(stored[1].text.empty());

  const motion::Features features = motion::extract_features_all_frames(
      database.motion(stored[0].clip_id), humanml_skeleton(), retriever.feature_mode());
  const retriever::MotionEncoding motion = retriever.encode_motion({&features});
  EXPECT_TRUE(torch::allclose(motion.global[0], torch::tensor(stored[0].motion), 1e-4, 1e-4));
  EXPECT_TRUE(
      torch::allclose(motion.parts[0].flatten(), torch::tensor(stored[0].parts), 1e-4, 1e-4));
  at::Tensor text = retriever.encode_text(named_clip("one").captions).query.mean(0);
  text = text / text.norm();
  EXPECT_TRUE(torch::allclose(text, torch::tensor(stored[0].text), 1e-4, 1e-4));

  database.add_clip(named_clip("three"), walking_motion(40, 3));
  EXPECT_EQ(retriever::embed_database(database, retriever), 1);
  EXPECT_EQ(retriever::embed_database(database, retriever), 0);
  EXPECT_EQ(retriever::embed_database(database, untrained_retriever(2)), 3);
  const auto later = database.embeddings(retriever.hash());
  ASSERT_EQ(later.size(), 3u);
  EXPECT_EQ(later[0].motion, stored[0].motion);  // untouched
  EXPECT_EQ(later[1].parts, stored[1].parts);
}

TEST(EmbedDatabase, LeavesVeryShortClipsOut) {
  const TestFolder folder;
  db::Database database(folder / "a.sqlite", db::OpenMode::create);
  database.add_clip(named_clip("short"), walking_motion(3, 1));
  database.add_clip(named_clip("long"), walking_motion(4, 2));
  const retriever::Retriever retriever = untrained_retriever(1);
  EXPECT_EQ(retriever::embed_database(database, retriever), 1);
  EXPECT_EQ(database.embedded_clips(retriever.hash()),
            std::vector<int64_t>{*database.find_name("long")});
  EXPECT_EQ(retriever::embed_database(database, retriever), 0);
}

TEST(EmbedDatabase, AStoppedRunKeepsWhatIsDone) {
  const TestFolder folder;
  db::Database database(folder / "a.sqlite", db::OpenMode::create);
  for (int i = 0; i < 70; ++i) {
    database.add_clip(named_clip("clip" + std::to_string(i)), walking_motion(10, i));
  }
  const retriever::Retriever retriever = untrained_retriever(1);
  std::stop_source stop;
  Monitor monitor;
  monitor.stop = stop.get_token();
  monitor.progress = [&](const Progress&) { stop.request_stop(); };
  EXPECT_THROW(retriever::embed_database(database, retriever, monitor), Interrupted);
  EXPECT_EQ(database.embedded_clips(retriever.hash()).size(), 32u);
  EXPECT_EQ(retriever::embed_database(database, retriever), 38);
}

}  // namespace
}  // namespace remomask
