#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "db/database.h"
#include "index/vector_index.h"

namespace remomask {

/// `count` random directions of `width` numbers, L2-normalised.
std::vector<float> random_directions(int64_t count, int width, uint64_t seed);

/// Directions around `centres` random centres: what approximate types are for.
std::vector<float> clustered_directions(int64_t count, int width, int64_t centres, uint64_t seed);

/// 1, 4, 7, ...: ids that are no row numbers.
std::vector<int64_t> sparse_ids(int64_t count);

/// All similarities in double, sorted by (similarity, id): the answer by definition.
std::vector<index::VectorHit> search_by_definition(const std::vector<int64_t>& ids,
                                                   const std::vector<float>& vectors, int width,
                                                   const float* query, int64_t k,
                                                   const std::vector<int64_t>* allowed = nullptr);

/// Equal clips and equal bits.
void expect_hits(const std::vector<index::VectorHit>& found,
                 const std::vector<index::VectorHit>& expected);

/// Stores a clip with a motion of its own (any number of frames), returns its id.
int64_t add_test_clip(db::Database& database, const db::Clip& clip, int frames = 40);

/// Stores these motion vectors for all clips, in the order of their ids.
void store_motion_vectors(db::Database& database, const std::string& retriever_hash,
                          const std::vector<float>& vectors, int width);

}  // namespace remomask
