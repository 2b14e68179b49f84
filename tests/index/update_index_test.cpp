#include "index/update_index.h"

#include <filesystem>

#include "base/file.h"
#include "base/hash.h"
#include "index/described_file.h"
#include "index/index_changes.h"
#include "tests/search/living_database.h"

namespace remomask {
namespace {

class UpdateIndexTest : public LivingDatabase {
 protected:
  index::IndexUpdate update(const index::UpdateOptions& options = {}) {
    const index::IndexUpdate made = index::update_index(path_, *database_, "retriever", options);
    EXPECT_EQ(made.count, static_cast<int64_t>(database_->embedded_clips("retriever").size()));
    EXPECT_EQ(made.width, kWidth);
    if (made.type.factory == "Flat") expect_present(opened());
    return made;
  }
};

TEST_F(UpdateIndexTest, BuildsThenAddsThenFolds) {
  const index::IndexUpdate first = update();
  EXPECT_EQ(first.rebuilt, "there was none");
  EXPECT_EQ(first.difference.added, 300);
  EXPECT_EQ(first.type.requested, "auto");
  const std::string base = read_file(path_);

  EXPECT_EQ(update().rebuilt, "");
  EXPECT_FALSE(std::filesystem::exists(index::delta_path(path_)));

  add(10);
  remove_every(100);  // 4 of 310, one of them new
  const index::IndexUpdate second = update();
  EXPECT_EQ(second.rebuilt, "");
  EXPECT_EQ(second.difference.added, 9);
  EXPECT_EQ(second.difference.dropped, 3);
  EXPECT_EQ(read_file(path_), base);

  add(1);
  const index::IndexUpdate third = update();
  EXPECT_EQ(third.difference.added, 1);
  EXPECT_EQ(third.difference.dropped, 0);
  EXPECT_EQ(read_file(path_), base);

  add(40);
  EXPECT_EQ(update().rebuilt, "many clips have changed");
  EXPECT_NE(read_file(path_), base);
  EXPECT_FALSE(std::filesystem::exists(index::delta_path(path_)));
}

TEST_F(UpdateIndexTest, WritesWhatAFollowedIndexSaves) {
  update();
  add(7);
  remove_every(77);
  auto index = opened();
  index.save(path_);
  const std::string saved = read_file(index::delta_path(path_));
  std::filesystem::remove(index::delta_path(path_));
  update();
  EXPECT_EQ(read_file(index::delta_path(path_)), saved);
}

TEST_F(UpdateIndexTest, KeepsTheTypeUnlessAnotherIsAskedFor) {
  index::UpdateOptions lists;
  lists.type = index::VectorIndexOptions{"IVF4,Flat", "nprobe=3"};
  update();
  const index::IndexUpdate changed = update(lists);
  EXPECT_EQ(changed.rebuilt, "another type is wanted");
  EXPECT_TRUE(changed.type.recall.has_value());
  EXPECT_EQ(changed.difference.added, 0);
  add(2);
  EXPECT_EQ(update().type.factory, "IVF4,Flat");
  EXPECT_EQ(update(lists).rebuilt, "");
  index::UpdateOptions rebuild;
  rebuild.rebuild = true;
  const index::IndexUpdate again = update(rebuild);
  EXPECT_EQ(again.rebuilt, "asked for");
  EXPECT_EQ(again.type.factory, "IVF4,Flat");
  EXPECT_EQ(again.type.search_parameters, "nprobe=3");
  index::UpdateOptions chosen;
  chosen.type = index::VectorIndexOptions{};
  EXPECT_EQ(update(chosen).type.factory, "Flat");
}

TEST_F(UpdateIndexTest, MendsDamage) {
  update();
  add(3);
  update();
  const std::string delta = read_file(index::delta_path(path_));
  write_file_atomically(index::delta_path(path_), delta.substr(0, delta.size() / 2));
  EXPECT_NE(error_of([&] { opened(); }), "");
  EXPECT_EQ(update().rebuilt, "");  // the delta alone is made again
  EXPECT_EQ(read_file(index::delta_path(path_)), delta);

  const std::string base = read_file(path_);
  write_file_atomically(path_, base.substr(0, base.size() / 2));
  EXPECT_NE(update().rebuilt.find("truncated"), std::string::npos);
}

TEST_F(UpdateIndexTest, RefusesChangesWhoseSizesBeginAgainAtZero) {
  static_assert(kWidth % 2 == 0, "the bytes of the vectors shall be a multiple of 2^64");
  update();
  add(3);
  update();
  const std::string path = index::delta_path(path_);
  nlohmann::json description =
      index::split_described(path, read_file(path), "RMMDELTA", "").description;
  description["added"] = uint64_t{1} << 61;
  description["dropped"] = 0;
  description["checksum"] = content_hash("");
  write_file_atomically(path, index::describe(description, "RMMDELTA"));
  EXPECT_NE(error_of([&] { opened(); }).find("the index is damaged"), std::string::npos);
}

TEST_F(UpdateIndexTest, ReplacesAnIndexOfAnotherOrigin) {
  update();
  database_->store_embeddings("newer", database_->embeddings("retriever"));
  const index::IndexUpdate made = index::update_index(path_, *database_, "newer");
  EXPECT_NE(made.rebuilt.find("another retriever"), std::string::npos);
  EXPECT_EQ(made.difference.added, 300);
  EXPECT_EQ(index::VectorIndex::open(path_, *database_, "newer").count(), 300);
}

TEST_F(UpdateIndexTest, FollowsDownToNothingAndUpAgain) {
  update();
  remove_every(1);
  EXPECT_NE(
      error_of([&] { index::update_index(path_, *database_, "retriever"); }).find("has no vectors"),
      std::string::npos);
  EXPECT_EQ(opened().count(), 0);
  add(5);
  EXPECT_EQ(update().difference.dropped, 300);
}

}  // namespace
}  // namespace remomask
