#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace remomask::index {

struct RowScore {
  int64_t row = 0;
  float score = 0;  ///< inner product, summed in double and rounded once
};

/// The rows that a scan looks at.
struct RowChoice {
  const std::vector<int64_t>* rows = nullptr;     ///< only these, ascending; null: all
  const std::vector<uint8_t>* skipped = nullptr;  ///< [count], 1: not this one; null: none
};

/// The `k` rows with the highest inner product with each query, best first, equal scores in the
/// order of their rows; fewer if there are fewer rows. `vectors` [count][width] and `queries`
/// [query_count][width] have L2 norms of at most 1.01 and finite values. The answer is exact: it
/// does not depend on the number of threads, on the other queries of a batch, or on the BLAS
/// library.
std::vector<std::vector<RowScore>> exact_top_k(const float* vectors, int64_t count, int width,
                                               const RowChoice& choice, const float* queries,
                                               int64_t query_count, int64_t k);

/// Throws Error that begins with `subject` if the L2 norm is not within 0.001 of 1.
void require_unit_length(const float* vector, int width, const std::string& subject);

}  // namespace remomask::index
