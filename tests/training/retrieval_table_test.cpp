#include "training/retrieval_table.h"

#include <gtest/gtest.h>
#include <torch/types.h>

#include <set>

namespace remomask {
namespace {

at::Tensor unit_rows(int64_t count, int64_t width) {
  const auto x = torch::randn({count, width});
  return x / x.norm(2, 1, true);
}

TEST(RetrievalTable, HandMadeNeighbours) {
  const auto motions = torch::tensor({1.f, 0.f, 0.8f, 0.6f, 0.6f, 0.8f, 0.f, 1.f}).reshape({4, 2});
  training::RetrievalQueries queries;
  queries.text = torch::tensor({1.f, 0.f}).reshape({1, 2});
  queries.own_motion = torch::tensor({0.f, -1.f}).reshape({1, 2});
  queries.kinds.groups = {1};
  const training::RetrievalTable table =
      training::build_retrieval_table(queries, motions, {{0, 1, 2, 3}, {}});
  EXPECT_TRUE(torch::equal(table.neighbours, torch::tensor({{0, 2, 3, -1}}, torch::kLong)));
  EXPECT_NEAR(table.similarity[0][1].item<float>(), 0.6f, 1e-6f);

  queries.kinds.meanings = {7};  // what motion 2 shows too
  const training::RetrievalTable others =
      training::build_retrieval_table(queries, motions, {{0, 1, 2, 3}, {6, 7, 7, 5}});
  EXPECT_TRUE(torch::equal(others.neighbours, torch::tensor({{0, 3, -1, -1}}, torch::kLong)));
}

TEST(RetrievalTable, NeverReturnsAnExcludedMotion) {
  torch::manual_seed(51);
  const int64_t count = 60;
  auto motions = unit_rows(count, 8);
  std::vector<int> groups;
  for (int64_t i = 0; i < count; ++i) groups.push_back(static_cast<int>(i / 3));
  motions[7] = motions[30];  // a duplicate in another group
  training::RetrievalQueries queries;
  queries.text = motions + 0.1 * torch::randn({count, 8});
  queries.own_motion = motions;
  queries.kinds.groups = groups;
  training::RetrievalTableOptions options;
  options.block = 7;
  const training::RetrievalTable table =
      training::build_retrieval_table(queries, motions, {groups, {}}, options);
  for (int64_t q = 0; q < count; ++q) {
    for (int64_t rank = 0; rank < table.neighbours.size(1); ++rank) {
      const int64_t hit = table.neighbours[q][rank].item<int64_t>();
      if (hit < 0) continue;
      ASSERT_NE(groups[hit], groups[q]);
      ASSERT_LE((motions[hit] * motions[q]).sum().item<float>(), 0.98f + 1e-6f);
    }
  }
  CounterRandom random(8);
  for (int64_t q = 0; q < count; ++q) {
    for (const training::DrawnHit& hit : training::draw_hits(table, q, 4, 0.5, random)) {
      ASSERT_NE(groups[hit.motion], groups[q]);
    }
  }
}

TEST(RetrievalTable, DrawsUniformCountsAndSomeNoise) {
  torch::manual_seed(52);
  const int64_t count = 150;
  const auto motions = unit_rows(count, 16);
  std::vector<int> groups(count);
  for (int i = 0; i < count; ++i) groups[i] = i;
  const training::RetrievalTable table = training::build_retrieval_table(
      {unit_rows(1, 16), unit_rows(1, 16), {{-1}, {}}}, motions, {groups, {}});
  std::set<int64_t> best;
  for (int i = 0; i < 20; ++i) best.insert(table.neighbours[0][i].item<int64_t>());
  CounterRandom random(9);
  std::vector<int> sizes(5, 0);
  double hits = 0, far = 0;
  for (int i = 0; i < 10000; ++i) {
    const auto drawn = training::draw_hits(table, 0, 4, 0.1, random);
    ++sizes[drawn.size()];
    for (const training::DrawnHit& hit : drawn) {
      ++hits;
      far += best.count(hit.motion) == 0;
    }
  }
  for (const int size : sizes) EXPECT_NEAR(size, 2000, 150);
  EXPECT_NEAR(far / hits, 0.1, 0.01);
  EXPECT_EQ(training::best_hits(table, 0, 3).size(), 3u);
  EXPECT_EQ(training::best_hits(table, 0, 3)[2].motion, table.neighbours[0][2].item<int64_t>());
}

}  // namespace
}  // namespace remomask
