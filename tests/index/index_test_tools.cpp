#include "tests/index/index_test_tools.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/random.h"

namespace remomask {

namespace {

void normalise_rows(std::vector<float>& vectors, int width) {
  for (size_t start = 0; start < vectors.size(); start += static_cast<size_t>(width)) {
    double square = 0;
    for (int i = 0; i < width; ++i) square += std::pow(vectors[start + static_cast<size_t>(i)], 2);
    for (int i = 0; i < width; ++i) {
      vectors[start + static_cast<size_t>(i)] /= static_cast<float>(std::sqrt(square));
    }
  }
}

}  // namespace

std::vector<float> random_directions(int64_t count, int width, uint64_t seed) {
  CounterRandom random(seed);
  std::vector<float> vectors(static_cast<size_t>(count * width));
  for (float& value : vectors) value = static_cast<float>(random.normal());
  normalise_rows(vectors, width);
  return vectors;
}

std::vector<float> clustered_directions(int64_t count, int width, int64_t centres, uint64_t seed) {
  const std::vector<float> middles = random_directions(centres, width, mix_seed(7, 1));
  std::vector<float> vectors = random_directions(count, width, seed);
  for (size_t i = 0; i < vectors.size(); ++i) {
    const size_t row = i / static_cast<size_t>(width), column = i % static_cast<size_t>(width);
    const size_t centre = row % static_cast<size_t>(centres);
    vectors[i] = middles[centre * static_cast<size_t>(width) + column] + 0.5f * vectors[i];
  }
  normalise_rows(vectors, width);
  return vectors;
}

std::vector<int64_t> sparse_ids(int64_t count) {
  std::vector<int64_t> ids;
  for (int64_t i = 0; i < count; ++i) ids.push_back(3 * i + 1);
  return ids;
}

std::vector<index::VectorHit> search_by_definition(const std::vector<int64_t>& ids,
                                                   const std::vector<float>& vectors, int width,
                                                   const float* query, int64_t k,
                                                   const std::vector<int64_t>* allowed) {
  std::vector<index::VectorHit> hits;
  for (size_t row = 0; row < ids.size(); ++row) {
    if (allowed && !std::binary_search(allowed->begin(), allowed->end(), ids[row])) continue;
    double sum = 0;
    for (int i = 0; i < width; ++i) {
      sum +=
          static_cast<double>(vectors[row * static_cast<size_t>(width) + static_cast<size_t>(i)]) *
          query[i];
    }
    hits.push_back({ids[row], static_cast<float>(sum)});
  }
  std::sort(hits.begin(), hits.end(),
            [](const index::VectorHit& left, const index::VectorHit& right) {
              return left.similarity != right.similarity ? left.similarity > right.similarity
                                                         : left.clip_id < right.clip_id;
            });
  hits.resize(std::min(hits.size(), static_cast<size_t>(k)));
  return hits;
}

void expect_hits(const std::vector<index::VectorHit>& found,
                 const std::vector<index::VectorHit>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].clip_id, expected[i].clip_id) << "place " << i;
    EXPECT_EQ(found[i].similarity, expected[i].similarity) << "place " << i;
  }
}

int64_t add_test_clip(db::Database& database, const db::Clip& clip, int frames) {
  Motion motion(frames, 22);
  // Not the number of clips: that comes again after a removal.
  const auto number = static_cast<float>(std::hash<std::string>()(clip.name) % 1000003);
  for (size_t i = 0; i < motion.positions.size(); ++i) {
    motion.positions[i] = 0.001f * number + 0.01f * static_cast<float>(i % 89);
  }
  return database.add_clip(clip, motion);
}

void store_motion_vectors(db::Database& database, const std::string& retriever_hash,
                          const std::vector<float>& vectors, int width) {
  std::vector<db::ClipEmbedding> embeddings;
  auto next = vectors.begin();
  for (const db::Clip& clip : database.clips()) {
    db::ClipEmbedding embedding;
    embedding.clip_id = clip.id;
    embedding.motion.assign(next, next + width);
    embedding.parts.assign(12, 0.5f);
    embedding.text = embedding.motion;
    embeddings.push_back(std::move(embedding));
    next += width;
  }
  database.store_embeddings(retriever_hash, embeddings);
}

}  // namespace remomask
