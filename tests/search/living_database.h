#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "index/vector_index.h"
#include "tests/db/db_test_tools.h"
#include "tests/index/index_test_tools.h"

namespace remomask {

/// A database whose clips come and go, beside an index file. The vector of a
/// clip depends on its id alone, as those of a retriever do.
class LivingDatabase : public ::testing::Test {
 protected:
  static constexpr int kWidth = 24;

  void SetUp() override {
    database_.emplace(folder_ / "motions.sqlite", db::OpenMode::create);
    path_ = index::default_index_path(database_->path());
    add(300);
  }

  static std::vector<float> vector_of(int64_t id) {
    return random_directions(1, kWidth, 1000 + static_cast<uint64_t>(id));
  }

  /// Stores clips with their vectors.
  void add(int count) {
    std::vector<int64_t> ids;
    for (int i = 0; i < count; ++i) {
      ids.push_back(add_test_clip(*database_, named_clip("clip" + std::to_string(next_++)), 4));
    }
    embed(ids);
  }
  void embed(const std::vector<int64_t>& ids) {
    std::vector<db::ClipEmbedding> embeddings;
    for (const int64_t id : ids) embeddings.push_back({id, vector_of(id), {}, {}});
    database_->add_embeddings("retriever", embeddings);
  }
  /// Takes every `step`-th embedded clip away.
  void remove_every(size_t step) {
    const auto ids = database_->embedded_clips("retriever");
    std::vector<int64_t> removed;
    for (size_t i = 0; i < ids.size(); i += step) removed.push_back(ids[i]);
    database_->remove(removed);
  }

  std::vector<index::VectorHit> truth(const float* query, int64_t k) const {
    const auto ids = database_->embedded_clips("retriever");
    std::vector<float> vectors;
    for (const int64_t id : ids) {
      const auto vector = vector_of(id);
      vectors.insert(vectors.end(), vector.begin(), vector.end());
    }
    return search_by_definition(ids, vectors, kWidth, query, k);
  }

  /// That the index answers as the definition does over the present database.
  void expect_present(const index::VectorIndex& index) {
    ASSERT_EQ(index.clip_ids(), database_->embedded_clips("retriever"));
    EXPECT_EQ(index.stamp().generation, database_->generation());
    const auto found = index.search(queries_.data(), 6, 12);
    for (int64_t query = 0; query < 6; ++query) {
      expect_hits(found[static_cast<size_t>(query)], truth(queries_.data() + query * kWidth, 12));
    }
  }

  index::VectorIndex opened() { return index::VectorIndex::open(path_, *database_, "retriever"); }

  TestFolder folder_;
  std::optional<db::Database> database_;
  std::string path_;
  int next_ = 0;
  std::vector<float> queries_ = random_directions(6, kWidth, 5);
};

}  // namespace remomask
