#include "index/faiss_layout.h"

#include <faiss/IndexFlat.h>
#include <faiss/IndexHNSW.h>
#include <faiss/IndexIDMap.h>
#include <faiss/IndexIVFFlat.h>
#include <faiss/impl/io.h>
#include <faiss/index_io.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

namespace remomask {
namespace {

constexpr int kLayoutCount = 200, kLayoutWidth = 8;

std::string serialised(const faiss::Index& index) {
  faiss::VectorIOWriter writer;
  faiss::write_index(&index, &writer);
  return {reinterpret_cast<const char*>(writer.data.data()), writer.data.size()};
}

std::string with_ids(faiss::Index& inner) {
  std::vector<float> vectors(static_cast<size_t>(kLayoutCount) * kLayoutWidth);
  std::mt19937 random(1);
  for (float& value : vectors) value = static_cast<float>(random()) / 4e9f;
  if (!inner.is_trained) inner.train(kLayoutCount, vectors.data());
  faiss::IndexIDMap2 index(&inner);
  std::vector<int64_t> ids(kLayoutCount);
  for (int i = 0; i < kLayoutCount; ++i) ids[static_cast<size_t>(i)] = 3 * i + 1;
  index.add_with_ids(kLayoutCount, vectors.data(), ids.data());
  return serialised(index);
}

/// Every field of eight bytes that holds the count, changed to a huge one.
void expect_no_claims(const std::string& good) {
  const int64_t count = kLayoutCount, huge = int64_t{1} << 40;
  for (size_t at = 0; at + 8 <= good.size(); ++at) {
    if (std::memcmp(good.data() + at, &count, 8) != 0) continue;
    std::string bad(good);
    std::memcpy(bad.data() + at, &huge, 8);
    EXPECT_FALSE(index::fits_layout(bad, {kLayoutCount, kLayoutWidth}, true)) << at;
  }
  for (size_t size = 0; size < good.size(); size += 7) {
    EXPECT_FALSE(index::fits_layout(good.substr(0, size), {kLayoutCount, kLayoutWidth}, true))
        << size;
  }
  EXPECT_FALSE(index::fits_layout(good, {kLayoutCount + 1, kLayoutWidth}, true));
  EXPECT_FALSE(index::fits_layout(good, {kLayoutCount, kLayoutWidth + 1}, true));
  EXPECT_FALSE(index::fits_layout(good + "x", {kLayoutCount, kLayoutWidth}, true));
}

TEST(FaissLayout, HnswIsWalkedThroughItsGraph) {
  faiss::IndexHNSWFlat inner(kLayoutWidth, 4);
  inner.metric_type = faiss::METRIC_INNER_PRODUCT;
  const std::string good = with_ids(inner);
  EXPECT_TRUE(index::fits_layout(good, {kLayoutCount, kLayoutWidth}, true));
  expect_no_claims(good);
  // The sizes fit, what they hold does not.
  const auto damaged = [&](auto damage) {
    faiss::IndexHNSWFlat copy(inner);
    copy.own_fields = false;
    damage(copy.hnsw);
    copy.ntotal = 0;  // as it must be when the map is made
    faiss::IndexIDMap2 index(&copy);
    copy.ntotal = index.ntotal = kLayoutCount;
    index.id_map.assign(kLayoutCount, 1);
    return !index::fits_layout(serialised(index), {kLayoutCount, kLayoutWidth}, true);
  };
  EXPECT_FALSE(damaged([](faiss::HNSW&) {}));
  EXPECT_TRUE(damaged([](faiss::HNSW& graph) { graph.neighbors[0] = kLayoutCount; }));
  EXPECT_TRUE(damaged([](faiss::HNSW& graph) { graph.neighbors[0] = -2; }));
  EXPECT_TRUE(damaged([](faiss::HNSW& graph) { graph.entry_point = kLayoutCount; }));
  EXPECT_TRUE(damaged([](faiss::HNSW& graph) { graph.max_level = 40; }));
  EXPECT_TRUE(damaged([](faiss::HNSW& graph) { graph.offsets[1] += 1; }));
  EXPECT_TRUE(damaged([](faiss::HNSW& graph) { graph.levels[3] = 60; }));
  EXPECT_TRUE(damaged([](faiss::HNSW& graph) { graph.cum_nneighbor_per_level[1] += 1; }));
}

TEST(FaissLayout, FlatIsWalkedToItsEnd) {
  faiss::IndexFlatIP inner(kLayoutWidth);
  const std::string good = with_ids(inner);
  EXPECT_TRUE(index::fits_layout(good, {kLayoutCount, kLayoutWidth}, true));
  EXPECT_TRUE(index::fits_layout(serialised(inner), {kLayoutCount, kLayoutWidth}, false));
  expect_no_claims(good);
}

TEST(FaissLayout, ListsAreWalkedToTheirEnd) {
  for (const size_t lists : {4u, 150u}) {  // written as full, and as sparse
    faiss::IndexFlatIP quantizer(kLayoutWidth);
    faiss::IndexIVFFlat inner(&quantizer, kLayoutWidth, lists, faiss::METRIC_INNER_PRODUCT);
    inner.cp.min_points_per_centroid = 1;
    const std::string good = with_ids(inner);
    EXPECT_TRUE(index::fits_layout(good, {kLayoutCount, kLayoutWidth}, true)) << lists;
    expect_no_claims(good);
  }
}

}  // namespace
}  // namespace remomask
