#include <filesystem>

#include "base/file.h"
#include "base/random.h"
#include "index/index_changes.h"
#include "index/update_index.h"
#include "tests/search/living_database.h"

namespace remomask {
namespace {

class FollowTest : public LivingDatabase {};

TEST_F(FollowTest, EqualsARebuildForEveryType) {
  // With all lists visited and 1.5 bytes of search depth a clip, these
  // approximate types find everything: any difference is a mistake.
  const std::vector<index::VectorIndexOptions> types = {
      {}, {"IVF8,Flat", "nprobe=8"}, {"HNSW16", "efSearch=500"}, {"SQfp16", ""}};
  std::vector<index::VectorIndex> indexes;
  for (const auto& type : types) {
    indexes.push_back(index::VectorIndex::build(*database_, "retriever", type));
  }
  for (const size_t removed : {7, 40, 3}) {
    add(25);
    remove_every(removed);
    for (index::VectorIndex& index : indexes) {
      index.follow(*database_);
      expect_present(index);
      const auto rebuilt = index::VectorIndex::build(
          *database_, "retriever", {index.type().factory, index.type().search_parameters});
      const auto expected = rebuilt.search(queries_.data(), 6, 12);
      const auto found = index.search(queries_.data(), 6, 12);
      for (size_t i = 0; i < 6; ++i) expect_hits(found[i], expected[i]);
    }
  }
}

TEST_F(FollowTest, CountsWhatCameAndWent) {
  auto index = index::VectorIndex::build(*database_, "retriever");
  add(5);
  remove_every(61);  // 5 of 305
  const index::IndexDifference difference = index.follow(*database_);
  EXPECT_EQ(difference.added, 5);
  EXPECT_EQ(difference.dropped, 5);
  const index::IndexDifference again = index.follow(*database_);
  EXPECT_EQ(again.added + again.dropped, 0);
}

TEST_F(FollowTest, VectorsThatComeBackAreFoundAgain) {
  auto index = index::VectorIndex::build(*database_, "retriever");
  const auto all = database_->embeddings("retriever");
  // As after new captions of a third of the clips: vectors dropped, then made again.
  database_->store_embeddings("retriever", {all.begin() + 100, all.end()});
  EXPECT_EQ(index.follow(*database_).dropped, 100);
  expect_present(index);
  database_->add_embeddings("retriever", {all.begin(), all.begin() + 100});
  EXPECT_EQ(index.follow(*database_).added, 100);
  expect_present(index);
}

TEST_F(FollowTest, HnswForgetsWholeNeighbourhoods) {
  auto graph = index::VectorIndex::build(*database_, "retriever", {"HNSW8", "efSearch=16"});
  auto thorough = index::VectorIndex::build(*database_, "retriever", {"HNSW8", "efSearch=400"});
  for (int64_t query = 0; query < 6; ++query) {
    const float* vector = queries_.data() + query * kWidth;
    std::vector<int64_t> nearest;
    for (const index::VectorHit& hit : truth(vector, 40)) nearest.push_back(hit.clip_id);
    database_->remove(nearest);
    graph.follow(*database_);
    thorough.follow(*database_);
    expect_hits(thorough.search(vector, 1, 10).front(), truth(vector, 10));
    const auto found = graph.search(vector, 1, 10).front();
    ASSERT_EQ(found.size(), 10u);
    const auto present = database_->embedded_clips("retriever");
    for (const index::VectorHit& hit : found) {
      EXPECT_TRUE(std::binary_search(present.begin(), present.end(), hit.clip_id));
    }
  }
}

TEST_F(FollowTest, FiltersHoldForBaseAndAddedClips) {
  for (const char* factory : {"Flat", "IVF8,Flat", "HNSW8"}) {
    auto index = index::VectorIndex::build(*database_, "retriever", {factory, ""});
    add(100);
    remove_every(9);
    index.follow(*database_);
    const auto present = database_->embedded_clips("retriever");
    for (const size_t step : {2, 20, 200}) {
      std::vector<int64_t> allowed;
      for (size_t i = 1; i < present.size(); i += step) allowed.push_back(present[i]);
      std::vector<float> vectors;
      for (const int64_t id : allowed) {
        const auto vector = vector_of(id);
        vectors.insert(vectors.end(), vector.begin(), vector.end());
      }
      auto asked = allowed;  // also clips that are gone
      for (int64_t id = 1; id < 20; ++id) {
        if (!std::binary_search(present.begin(), present.end(), id)) asked.push_back(id);
      }
      std::sort(asked.begin(), asked.end());
      expect_hits(index.search(queries_.data(), 1, 10, &asked).front(),
                  search_by_definition(allowed, vectors, kWidth, queries_.data(), 10));
    }
  }
}

TEST_F(FollowTest, AnEmptyDatabaseFindsNothing) {
  auto index = index::VectorIndex::build(*database_, "retriever");
  remove_every(1);
  index.follow(*database_);
  EXPECT_EQ(index.count(), 0);
  EXPECT_TRUE(index.search(queries_.data(), 2, 5)[1].empty());
  EXPECT_NE(error_of([&] { index.save(path_); }).find("without clips"), std::string::npos);
}

TEST_F(FollowTest, TheLogOfChangesAndTheListOfClipsSayTheSame) {
  auto by_log = index::VectorIndex::build(*database_, "retriever");
  auto by_list = index::VectorIndex::build(*database_, "retriever");
  const std::string path = database_->path();
  CounterRandom random(7);
  for (int round = 0; round < 30; ++round) {
    const size_t kind = random.below(4);
    if (kind == 0) add(1 + static_cast<int>(random.below(9)));
    if (kind == 1) remove_every(11 + random.below(200));
    const auto ids = database_->embedded_clips("retriever");
    const int64_t some = ids[random.below(ids.size())];
    if (kind == 2) {  // new captions drop the vectors; half of them are made again
      db::ClipChanges changes;
      changes.captions = {"a person does number " + std::to_string(round)};
      database_->update_clip(some, changes);
      if (round % 2 == 0) embed({some});
    }
    if (kind == 3) embed({some, ids.front()});  // the same ones again
    if (round % 3 == 0) continue;               // several changes at once
    const index::IndexDifference logged = by_log.follow(*database_);
    run_sql(path, "UPDATE fact SET value = '1000000' WHERE key = 'changes_since'");
    ASSERT_FALSE(database_->embedding_changes("retriever", database_->generation()));
    const index::IndexDifference listed = by_list.follow(*database_);
    run_sql(path, "UPDATE fact SET value = '0' WHERE key = 'changes_since'");
    EXPECT_EQ(logged.added, listed.added) << round;
    EXPECT_EQ(logged.dropped, listed.dropped) << round;
    expect_present(by_log);
    expect_present(by_list);
  }
}

class DeltaTest : public LivingDatabase {
 protected:
  void SetUp() override {
    LivingDatabase::SetUp();
    index::VectorIndex::build(*database_, "retriever").save(path_);
    first_base_ = read_file(path_);
  }
  void follow_and_save() {
    auto index = opened();
    index.follow(*database_);
    index.save(path_);
  }

  std::string first_base_;
};

TEST_F(DeltaTest, SaveWritesOnlyTheChanges) {
  add(8);
  remove_every(60);
  follow_and_save();
  EXPECT_EQ(read_file(path_), first_base_);
  EXPECT_LT(std::filesystem::file_size(index::delta_path(path_)), first_base_.size() / 10);
  expect_present(opened());
  // More upon them, and the clips of the delta may go too.
  add(3);
  remove_every(50);
  follow_and_save();
  EXPECT_EQ(read_file(path_), first_base_);
  expect_present(opened());
}

TEST_F(DeltaTest, OpensWithoutSavingWhatIsNew) {
  add(4);
  expect_present(opened());
  EXPECT_FALSE(std::filesystem::exists(index::delta_path(path_)));
}

TEST_F(DeltaTest, ManyChangesBecomeANewBase) {
  for (const char* factory : {"Flat", "HNSW8", "IVF4,Flat"}) {
    const index::VectorIndexOptions type{factory,
                                         factory == std::string("IVF4,Flat") ? "nprobe=4" : ""};
    index::VectorIndex::build(*database_, "retriever", type).save(path_);
    const std::string base = read_file(path_);
    add(5);
    follow_and_save();
    ASSERT_EQ(read_file(path_), base) << factory;
    ASSERT_TRUE(std::filesystem::exists(index::delta_path(path_)));
    add(60);
    remove_every(10);
    follow_and_save();
    EXPECT_NE(read_file(path_), base) << factory;
    EXPECT_FALSE(std::filesystem::exists(index::delta_path(path_)));
    EXPECT_EQ(opened().type().factory, factory);
    EXPECT_EQ(opened().clip_ids(), database_->embedded_clips("retriever"));
    if (factory != std::string("HNSW8")) expect_present(opened());
  }
}

TEST_F(DeltaTest, RefusesEveryCutAndEveryFlippedByte) {
  add(6);
  remove_every(100);
  follow_and_save();
  const std::string content = read_file(index::delta_path(path_));
  for (size_t i = 0; i < 60; ++i) {
    const size_t position = i * (content.size() - 1) / 59;
    write_file_atomically(index::delta_path(path_), content.substr(0, position));
    EXPECT_THROW(opened(), FileError) << "cut at " << position;
    std::string flipped = content;
    flipped[position] = static_cast<char>(flipped[position] ^ 0x10);
    write_file_atomically(index::delta_path(path_), flipped);
    EXPECT_NE(error_of([&] { opened(); }).find("run: remomask index DB"), std::string::npos)
        << "flipped at " << position;
  }
}

TEST_F(DeltaTest, AKillBetweenBaseAndDeltaLeavesAReadablePair) {
  add(6);
  remove_every(100);
  follow_and_save();
  const std::string first_delta = read_file(index::delta_path(path_));
  add(50);
  remove_every(20);
  follow_and_save();  // a new base
  const std::string second_base = read_file(path_);
  ASSERT_NE(second_base, first_base_);
  add(2);
  follow_and_save();
  const std::string second_delta = read_file(index::delta_path(path_));
  ASSERT_EQ(read_file(path_), second_base);
  // A new base is renamed into place before its old delta is removed, and a
  // reader may see either file old or new.
  for (const std::string& base : {first_base_, second_base}) {
    for (const std::string& delta : {first_delta, second_delta}) {
      write_file_atomically(path_, base);
      write_file_atomically(index::delta_path(path_), delta);
      expect_present(opened());
      follow_and_save();
      expect_present(opened());
    }
  }
}

TEST_F(DeltaTest, CopiesThatWereChangedApartDoNotShareAnIndex) {
  const std::string copy_path = folder_ / "copy.sqlite";
  run_sql(database_->path(), ("VACUUM INTO '" + copy_path + "'").c_str());
  const std::string copy_index = index::default_index_path(copy_path);
  write_file_atomically(copy_index, first_base_);
  remove_every(50);
  add(4);
  follow_and_save();
  {
    // Here the same ids are given to other clips.
    db::Database copy(copy_path, db::OpenMode::read_write);
    std::vector<db::ClipEmbedding> embeddings;
    for (int i = 0; i < 7; ++i) {
      const int64_t id = add_test_clip(copy, named_clip("own" + std::to_string(i)), 4);
      embeddings.push_back({id, vector_of(5000 + id), {}, {}});
    }
    copy.add_embeddings("retriever", embeddings);
    auto index = index::VectorIndex::open(copy_index, copy, "retriever");  // of the common past
    EXPECT_EQ(index.count(), 307);
    index.save(copy_index);
  }
  const std::string own = read_file(index::delta_path(path_)),
                    other = read_file(index::delta_path(copy_index));
  write_file_atomically(index::delta_path(path_), other);
  write_file_atomically(index::delta_path(copy_index), own);
  const db::Database copy(copy_path, db::OpenMode::read_only);
  const auto of_copy = [&] { return index::VectorIndex::open(copy_index, copy, "retriever"); };
  EXPECT_NE(error_of([&] { of_copy(); }).find("changed separately"), std::string::npos);
  // Whichever is further on: the one here now passes the other.
  while (database_->generation() <= copy.generation()) add(1);
  EXPECT_NE(error_of([&] { opened(); }).find("changed separately"), std::string::npos);
  EXPECT_NE(index::update_index(path_, *database_, "retriever").rebuilt.find("changed separately"),
            std::string::npos);
  expect_present(opened());
  index::update_index(copy_index, copy, "retriever");
  EXPECT_EQ(of_copy().count(), 307);
}

TEST_F(DeltaTest, SavesAWholeIndexWhereItsBaseIsNot) {
  add(5);
  auto index = opened();
  const std::string elsewhere = folder_ / "elsewhere.index";
  index.save(elsewhere);
  EXPECT_FALSE(std::filesystem::exists(index::delta_path(elsewhere)));
  expect_present(index::VectorIndex::open(elsewhere, *database_, "retriever"));
  // The base was replaced or damaged by another program since it was opened.
  auto second = opened();
  write_file_atomically(path_, "damaged");
  add(1);
  second.follow(*database_);
  second.save(path_);
  expect_present(opened());
}

}  // namespace
}  // namespace remomask
