#include "index/vector_index.h"

#include <faiss/IndexIVF.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <thread>

#include "base/file.h"
#include "base/random.h"
#include "index/faiss_index.h"
#include "index/recall.h"
#include "tests/db/db_test_tools.h"
#include "tests/index/index_test_tools.h"

namespace remomask {
namespace {

constexpr int kWidth = 48;

double recall(const index::VectorIndex& index, const std::vector<int64_t>& ids,
              const std::vector<float>& vectors, const std::vector<float>& queries, int64_t k) {
  const auto count = static_cast<int64_t>(queries.size()) / kWidth;
  const auto hits = index.search(queries.data(), count, k);
  double right = 0;
  for (int64_t query = 0; query < count; ++query) {
    const auto truth =
        search_by_definition(ids, vectors, kWidth, queries.data() + query * kWidth, k);
    for (const index::VectorHit& hit : hits[static_cast<size_t>(query)]) {
      right += std::any_of(truth.begin(), truth.end(), [&](const index::VectorHit& wanted) {
        return wanted.clip_id == hit.clip_id && wanted.similarity == hit.similarity;
      });
    }
  }
  return right / static_cast<double>(count * k);
}

TEST(VectorIndex, EqualsTheDefinitionForEverySelectivity) {
  constexpr int64_t kCount = 6000, kQueries = 5;
  const auto ids = sparse_ids(kCount);
  const auto vectors = random_directions(kCount, kWidth, 1);
  const auto queries = random_directions(kQueries, kWidth, 2);
  const index::VectorIndex index({"uuid", 1, "retriever"}, ids, vectors, kWidth);
  for (const double selectivity : {1.0, 0.5, 0.05, 0.005}) {
    CounterRandom random(mix_seed(3, static_cast<uint64_t>(selectivity * 1000)));
    std::vector<int64_t> allowed;
    for (const int64_t id : ids) {
      if (random.uniform() < selectivity) allowed.push_back(id);
    }
    ASSERT_NEAR(static_cast<double>(allowed.size()) / kCount, selectivity, 0.02);
    const auto hits = index.search(queries.data(), kQueries, 10, &allowed);
    for (int64_t query = 0; query < kQueries; ++query) {
      expect_hits(hits[static_cast<size_t>(query)],
                  search_by_definition(ids, vectors, kWidth, queries.data() + query * kWidth, 10,
                                       &allowed));
    }
  }
}

TEST(VectorIndex, OneQueryOrABatchFindTheSame) {
  constexpr int64_t kCount = 3000, kQueries = 300;  // more than one batch of the scan
  const auto ids = sparse_ids(kCount);
  const auto vectors = random_directions(kCount, kWidth, 4);
  const auto queries = random_directions(kQueries, kWidth, 5);
  const index::VectorIndex index({"uuid", 1, "retriever"}, ids, vectors, kWidth);
  const auto together = index.search(queries.data(), kQueries, 20);
  for (int64_t query = 0; query < kQueries; ++query) {
    const float* one = queries.data() + query * kWidth;
    expect_hits(together[static_cast<size_t>(query)], index.search(one, 1, 20).front());
    if (query % 50 == 0) {
      expect_hits(index.search(one, 1, 20).front(),
                  search_by_definition(ids, vectors, kWidth, one, 20));
    }
  }
}

TEST(VectorIndex, ReturnsAllWhenKIsLargerThanTheCount) {
  const auto ids = sparse_ids(7);
  const auto vectors = random_directions(7, kWidth, 6);
  const index::VectorIndex index({"uuid", 1, "retriever"}, ids, vectors, kWidth);
  const auto query = random_directions(1, kWidth, 7);
  expect_hits(index.search(query.data(), 1, 1000000).front(),
              search_by_definition(ids, vectors, kWidth, query.data(), 7));
  const std::vector<int64_t> allowed = {4, 5, 10};  // 5 is no clip of the index
  EXPECT_EQ(index.search(query.data(), 1, 9, &allowed).front().size(), 2u);
  const std::vector<int64_t> none;
  EXPECT_TRUE(index.search(query.data(), 1, 9, &none).front().empty());
  EXPECT_TRUE(index.search(query.data(), 0, 9).empty());
}

TEST(VectorIndex, EqualVectorsComeInTheOrderOfTheirIds) {
  // More ties than the scan keeps before it prunes, spread over the rows, and
  // given in falling order of their ids.
  constexpr int64_t kCount = 5000;
  const auto direction = random_directions(1, kWidth, 8);
  auto vectors = random_directions(kCount, kWidth, 9);
  std::vector<int64_t> ids = sparse_ids(kCount);
  std::reverse(ids.begin(), ids.end());
  std::vector<int64_t> equal;
  for (int64_t row = 0; row < kCount; ++row) {
    if (row % 3 != 0) continue;
    std::copy(direction.begin(), direction.end(), vectors.begin() + row * kWidth);
    equal.push_back(ids[static_cast<size_t>(row)]);
  }
  std::sort(equal.begin(), equal.end());
  const index::VectorIndex index({"uuid", 1, "retriever"}, ids, vectors, kWidth);
  for (const int64_t k : {int64_t{1}, int64_t{10}, int64_t{1600}}) {
    const auto hits = index.search(direction.data(), 1, k).front();
    ASSERT_EQ(static_cast<int64_t>(hits.size()), k);
    for (int64_t i = 0; i < k; ++i) {
      EXPECT_EQ(hits[static_cast<size_t>(i)].clip_id, equal[static_cast<size_t>(i)]);
    }
  }
}

TEST(VectorIndex, NearlyEqualVectorsAreOrderedRight) {
  // Differences of the size of the rounding of one float sum: the order in
  // which BLAS adds would decide.
  constexpr int64_t kCount = 4000;
  constexpr int kWide = 512;
  const auto direction = random_directions(1, kWide, 10);
  CounterRandom random(11);
  std::vector<float> vectors;
  for (int64_t row = 0; row < kCount; ++row) {
    for (const float value : direction) {
      vectors.push_back(value * (1.f + 4e-6f * static_cast<float>(random.normal())));
    }
  }
  const auto ids = sparse_ids(kCount);
  const index::VectorIndex index({"uuid", 1, "retriever"}, ids, vectors, kWide);
  for (const int64_t k : {1, 5, 50}) {
    expect_hits(index.search(direction.data(), 1, k).front(),
                search_by_definition(ids, vectors, kWide, direction.data(), k));
  }
}

TEST(VectorIndex, ApproximateTypesFindMostNeighbours) {
  constexpr int64_t kCount = 4000, kQueries = 50;
  const auto ids = sparse_ids(kCount);
  const auto vectors = clustered_directions(kCount, kWidth, 40, 11);
  const auto queries = clustered_directions(kQueries, kWidth, 40, 12);
  const index::IndexStamp stamp{"uuid", 1, "retriever"};
  const index::VectorIndex lists(stamp, ids, vectors, kWidth, {"IVF32,Flat", "nprobe=8"});
  EXPECT_GT(recall(lists, ids, vectors, queries, 10), 0.9);
  const index::VectorIndex all_lists(stamp, ids, vectors, kWidth, {"IVF32,Flat", "nprobe=32"});
  EXPECT_EQ(recall(all_lists, ids, vectors, queries, 10), 1.0);
  const index::VectorIndex graph(stamp, ids, vectors, kWidth, {"HNSW16", "efSearch=64"});
  EXPECT_GT(recall(graph, ids, vectors, queries, 10), 0.9);
  // Compressed vectors still give exact similarities of what they find.
  const index::VectorIndex compressed(stamp, ids, vectors, kWidth, {"SQ8", ""});
  EXPECT_GT(recall(compressed, ids, vectors, queries, 10), 0.9);
  // With a filter they scan exactly.
  for (const size_t step : {2, 20, 200}) {
    std::vector<int64_t> allowed;
    for (size_t i = 0; i < ids.size(); i += step) allowed.push_back(ids[i]);
    for (const index::VectorIndex* index : {&lists, &graph, &compressed}) {
      expect_hits(index->search(queries.data(), 1, 10, &allowed).front(),
                  search_by_definition(ids, vectors, kWidth, queries.data(), 10, &allowed));
    }
  }
}

TEST(VectorIndex, FindsKClipsThoughItsListsHoldFewer) {
  const auto ids = sparse_ids(200);
  const auto vectors = random_directions(200, kWidth, 19);
  const auto query = random_directions(1, kWidth, 20);
  const index::VectorIndex lists({"uuid", 1, "r"}, ids, vectors, kWidth,
                                 {"IVF50,Flat", "nprobe=1"});
  expect_hits(lists.search(query.data(), 1, 100).front(),
              search_by_definition(ids, vectors, kWidth, query.data(), 100));
}

TEST(VectorIndex, AutoChoosesByTheNumberOfVectors) {
  EXPECT_EQ(index::resolve_factory("HNSW32", 3), "HNSW32");
  EXPECT_EQ(index::resolve_factory("auto", 499999), "Flat");
  EXPECT_EQ(index::resolve_factory("auto", 500000), "IVF1024,Flat");   // 2 sqrt(n) = 1414
  EXPECT_EQ(index::resolve_factory("auto", 1000000), "IVF2048,Flat");  // 2000
  EXPECT_EQ(index::resolve_factory("auto", 1000000000), "IVF16384,Flat");
}

TEST(VectorIndex, ProbesAreTunedToTheRecall) {
  const auto ids = sparse_ids(3000);
  const auto vectors = clustered_directions(3000, kWidth, 100, 21);
  const index::IndexType type{"IVF64,Flat", "IVF64,Flat", "", std::nullopt};
  auto exact = std::make_unique<faiss::IndexFlat>(kWidth, faiss::METRIC_INNER_PRODUCT);
  exact->add(3000, vectors.data());
  index::IndexSegments segments(index::build_faiss_index(ids, vectors.data(), kWidth, type, {}),
                                std::move(exact));
  const index::RecallSample sample(segments);
  const double before = sample.measure(segments);  // one list a query
  const std::string chosen = index::tune_probes(segments, sample);
  EXPECT_GE(sample.measure(segments), 0.97);
  const int probes = std::stoi(chosen.substr(chosen.find('=') + 1));
  EXPECT_TRUE(std::has_single_bit(static_cast<unsigned>(probes))) << chosen;
  if (probes > 1) {
    EXPECT_LT(before, 0.97);
    dynamic_cast<faiss::IndexIVF*>(segments.base().index)->nprobe /= 2;
    EXPECT_LT(sample.measure(segments), 0.97);
  }
}

TEST(VectorIndex, ThreeThreadsReadAtOnce) {
  constexpr int64_t kCount = 3000, kQueries = 40;
  const auto ids = sparse_ids(kCount);
  const auto vectors = clustered_directions(kCount, kWidth, 30, 13);
  const auto queries = random_directions(kQueries, kWidth, 14);
  for (const index::VectorIndexOptions& options :
       {index::VectorIndexOptions{}, index::VectorIndexOptions{"IVF16,Flat", "nprobe=16"}}) {
    const index::VectorIndex index({"uuid", 1, "retriever"}, ids, vectors, kWidth, options);
    const auto expected = index.search(queries.data(), kQueries, 10);
    std::atomic<int> wrong = 0;
    const auto read = [&] {
      for (int64_t query = 0; query < kQueries; ++query) {
        const auto hits = index.search(queries.data() + query * kWidth, 1, 10).front();
        const auto& wanted = expected[static_cast<size_t>(query)];
        for (size_t i = 0; i < hits.size(); ++i) {
          if (hits[i].clip_id != wanted[i].clip_id || hits.size() != wanted.size()) ++wrong;
        }
      }
    };
    std::vector<std::thread> threads;
    for (int i = 0; i < 3; ++i) threads.emplace_back(read);
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, 0);
  }
}

TEST(VectorIndex, RefusesWrongInput) {
  const auto ids = sparse_ids(20);
  const auto vectors = random_directions(20, kWidth, 15);
  const index::IndexStamp stamp{"uuid", 1, "retriever"};
  const auto build_error = [&](const std::vector<int64_t>& some_ids,
                               const std::vector<float>& some_vectors,
                               const index::VectorIndexOptions& options = {}) {
    return error_of([&] { index::VectorIndex(stamp, some_ids, some_vectors, kWidth, options); });
  };
  auto doubled = ids;
  doubled[3] = doubled[4];
  EXPECT_NE(build_error(doubled, vectors).find("two vectors"), std::string::npos);
  auto longer = vectors;
  longer[0] += 1.f;
  EXPECT_NE(build_error(ids, longer).find("clip number 1 has length"), std::string::npos);
  auto broken = vectors;
  broken[5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(build_error(ids, broken).find("clip number 1 has length"), std::string::npos);
  EXPECT_NE(build_error(ids, {1.f}).find("one width"), std::string::npos);
  EXPECT_NE(build_error(ids, vectors, {"Flatt", ""}).find("\"Flatt\""), std::string::npos);
  EXPECT_NE(build_error(ids, vectors, {"IVF500,Flat", ""}).find("IVF500"), std::string::npos);
  EXPECT_NE(build_error(ids, vectors, {"IDMap,Flat", ""}).find("IDMap"), std::string::npos);
  EXPECT_NE(build_error(ids, vectors, {"Flat", "nprobes=3"}).find("nprobes"), std::string::npos);

  const index::VectorIndex index(stamp, ids, vectors, kWidth);
  EXPECT_NE(error_of([&] { index.search(vectors.data(), 1, 0); }).find("k must be 1"),
            std::string::npos);
  EXPECT_NE(error_of([&] { index.search(broken.data(), 1, 5); }).find("query 0"),
            std::string::npos);
}

TEST(VectorIndex, StopsOnRequest) {
  std::stop_source stop;
  Monitor monitor;
  monitor.stop = stop.get_token();
  stop.request_stop();
  EXPECT_THROW(index::VectorIndex({"uuid", 1, "r"}, sparse_ids(20),
                                  random_directions(20, kWidth, 16), kWidth, {}, monitor),
               Interrupted);
}

class StoredIndex : public ::testing::Test {
 protected:
  void SetUp() override {
    database_.emplace(folder_ / "motions.sqlite", db::OpenMode::create);
    for (int i = 0; i < 60; ++i) {
      add_test_clip(*database_, named_clip("clip" + std::to_string(i)));
    }
    store_motion_vectors(*database_, "retriever", random_directions(60, kWidth, 17), kWidth);
    path_ = index::default_index_path(database_->path());
  }

  std::string load_error(const std::string& retriever = "retriever") {
    return error_of([&] { index::VectorIndex::open(path_, *database_, retriever); });
  }

  TestFolder folder_;
  std::optional<db::Database> database_;
  std::string path_;
  std::vector<float> queries_ = random_directions(10, kWidth, 18);
};

TEST_F(StoredIndex, FindsTheSameAfterLoading) {
  for (const index::VectorIndexOptions& options :
       {index::VectorIndexOptions{}, index::VectorIndexOptions{"IVF4,Flat", "nprobe=2"},
        index::VectorIndexOptions{"HNSW8", "efSearch=20"}}) {
    auto built = index::VectorIndex::build(*database_, "retriever", options);
    built.save(path_);
    const auto loaded = index::VectorIndex::open(path_, *database_, "retriever");
    EXPECT_EQ(loaded.count(), 60);
    EXPECT_EQ(loaded.width(), kWidth);
    EXPECT_EQ(loaded.type().factory, built.type().factory);
    EXPECT_EQ(loaded.clip_ids(), built.clip_ids());
    const auto expected = built.search(queries_.data(), 10, 7);
    const auto found = loaded.search(queries_.data(), 10, 7);
    for (size_t i = 0; i < expected.size(); ++i) expect_hits(found[i], expected[i]);
  }
}

TEST_F(StoredIndex, RefusesAMissingFile) {
  EXPECT_NE(load_error().find("there is no index; run: remomask index DB"), std::string::npos);
}

TEST_F(StoredIndex, RefusesEveryCutAndEveryFlippedByte) {
  for (const char* factory : {"Flat", "IVF4,Flat"}) {
    index::VectorIndex::build(*database_, "retriever", {factory, ""}).save(path_);
    const std::string content = read_file(path_);
    for (size_t i = 0; i < 40; ++i) {
      const size_t position = i * (content.size() - 1) / 39;
      write_file_atomically(path_, content.substr(0, position));
      EXPECT_THROW(index::VectorIndex::open(path_, *database_, "retriever"), FileError)
          << "cut at " << position;
      std::string flipped = content;
      flipped[position] = static_cast<char>(flipped[position] ^ 0x10);
      write_file_atomically(path_, flipped);
      EXPECT_NE(load_error(), "") << "flipped at " << position;
    }
  }
  write_file_atomically(path_, "");
  EXPECT_NE(load_error().find("is not an index file"), std::string::npos);
}

TEST_F(StoredIndex, RefusesAnotherDatabase) {
  index::VectorIndex::build(*database_, "retriever").save(path_);
  const std::string other_path = folder_ / "other.sqlite";
  db::Database other(other_path, db::OpenMode::create);
  EXPECT_NE(error_of([&] {
              index::VectorIndex::open(path_, other, "retriever");
            }).find("does not belong to the database"),
            std::string::npos);
  auto index = index::VectorIndex::open(path_, *database_, "retriever");
  EXPECT_NE(error_of([&] { index.follow(other); }).find("does not belong to the database"),
            std::string::npos);
}

TEST_F(StoredIndex, RefusesALaterState) {
  const std::string copy = folder_ / "copy.sqlite";
  std::filesystem::copy_file(database_->path(), copy);
  for (const char* extra : {"-wal", "-shm"}) {
    if (std::filesystem::exists(database_->path() + extra)) {
      std::filesystem::copy_file(database_->path() + extra, copy + extra);
    }
  }
  add_test_clip(*database_, named_clip("one more"));
  index::VectorIndex::build(*database_, "retriever").save(path_);
  const db::Database older(copy, db::OpenMode::read_only);
  EXPECT_NE(
      error_of([&] { index::VectorIndex::open(path_, older, "retriever"); }).find("later state"),
      std::string::npos);
}

TEST_F(StoredIndex, KeepsItsTypeAndItsMeasuredRecall) {
  auto built = index::VectorIndex::build(*database_, "retriever", {"IVF8,Flat", "nprobe=2"});
  ASSERT_TRUE(built.type().recall.has_value());
  EXPECT_GT(*built.type().recall, 0.0);
  EXPECT_LT(*built.type().recall, 1.0);
  built.save(path_);
  const auto opened = index::VectorIndex::open(path_, *database_, "retriever");
  EXPECT_EQ(opened.type().requested, "IVF8,Flat");
  EXPECT_EQ(opened.type().search_parameters, "nprobe=2");
  EXPECT_EQ(opened.type().recall, built.type().recall);
  const auto flat = index::VectorIndex::build(*database_, "retriever");
  EXPECT_EQ(flat.type().requested, "auto");
  EXPECT_EQ(flat.type().factory, "Flat");
  EXPECT_FALSE(flat.type().recall.has_value());
}

TEST_F(StoredIndex, RefusesAnotherRetriever) {
  index::VectorIndex::build(*database_, "retriever").save(path_);
  EXPECT_NE(load_error("newer").find("another retriever"), std::string::npos);
  EXPECT_NE(
      error_of([&] { index::VectorIndex::build(*database_, "newer"); }).find("has no vectors"),
      std::string::npos);
}

TEST_F(StoredIndex, RefusesVectorsOfDifferentWidths) {
  auto embeddings = database_->embeddings("retriever");
  embeddings[3].motion.pop_back();
  database_->store_embeddings("retriever", embeddings);
  EXPECT_NE(
      error_of([&] { index::VectorIndex::build(*database_, "retriever"); }).find("47 numbers"),
      std::string::npos);
}

}  // namespace
}  // namespace remomask
