#include "index/exact_scan.h"

#include <cblas.h>
#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

#include "remomask/error.h"

namespace remomask::index {

namespace {

// Debian's FAISS has SSE2 code only and does not thread single queries, so it reads memory 4 to 10
// times slower than BLAS. BLAS in turn rounds differently by kernel, thread and position in a
// block, which would break ties between equal vectors at random. Hence two steps: BLAS finds every
// row that can be among the best within its error bound, then those few are summed again in one
// fixed order.

constexpr int64_t kMaxQueries = 256;              // of one matrix product
constexpr int64_t kMaxScores = int64_t{1} << 17;  // stay in the cache between product and choice
constexpr int64_t kGatheredRows = 4096;           // stay in the cache between copy and product
constexpr size_t kFirstLimit = 1024;
constexpr int64_t kScoresAtOnce = 32;  // compared with the threshold by vector instructions
constexpr double kNormTolerance = 1e-3;

/// Twice the bound |fl(x.y) - x.y| <= width * u * |x||y|, which holds for any order of summation
/// and norms up to 1.01, plus the final rounding.
float score_margin(int width) { return 1.1f * (static_cast<float>(width) + 2) * FLT_EPSILON; }

float exact_score(const float* left, const float* right, int width) {
  double sum = 0;
  for (int i = 0; i < width; ++i) sum += static_cast<double>(left[i]) * right[i];
  return static_cast<float>(sum);
}

bool better_score(const RowScore& left, const RowScore& right) {
  return left.score != right.score ? left.score > right.score : left.row < right.row;
}

/// Rows of one query that can still be among the k best.
class Candidates {
 public:
  Candidates(int64_t k, float margin) : k_(static_cast<size_t>(k)), margin_(margin) {
    limit_ = std::max(kFirstLimit, 2 * k_);
  }

  /// Scores of the rows first, first + 1, ... or, with `choice.rows`, of the rows at these
  /// positions of that list.
  void offer(const float* scores, int64_t count, int64_t first, const RowChoice& choice) {
    int64_t i = 0;
    for (; i + kScoresAtOnce <= count; i += kScoresAtOnce) {
      if (any_reaches(scores + i)) take(scores + i, kScoresAtOnce, first + i, choice);
    }
    take(scores + i, count - i, first + i, choice);
  }

  std::vector<RowScore> finish(const float* vectors, const float* query, int width) {
    if (found_.size() > k_) prune();
    for (RowScore& candidate : found_) {
      candidate.score = exact_score(vectors + candidate.row * width, query, width);
    }
    const size_t kept = std::min(k_, found_.size());
    std::partial_sort(found_.begin(), found_.begin() + static_cast<std::ptrdiff_t>(kept),
                      found_.end(), better_score);
    found_.resize(kept);
    return std::move(found_);
  }

 private:
  bool any_reaches(const float* scores) const {
    int reached = 0;
    for (int64_t i = 0; i < kScoresAtOnce; ++i) reached |= scores[i] >= threshold_;
    return reached != 0;
  }

  void take(const float* scores, int64_t count, int64_t first, const RowChoice& choice) {
    for (int64_t i = 0; i < count; ++i) {
      if (scores[i] < threshold_) continue;
      const int64_t row = choice.rows ? (*choice.rows)[static_cast<size_t>(first + i)] : first + i;
      if (choice.skipped && (*choice.skipped)[static_cast<size_t>(row)]) continue;
      found_.push_back({row, scores[i]});
      if (found_.size() >= limit_) prune();
    }
  }

  void prune() {
    const auto last = found_.begin() + static_cast<std::ptrdiff_t>(k_) - 1;
    std::nth_element(found_.begin(), last, found_.end(), better_score);
    threshold_ = last->score - margin_;
    std::erase_if(found_, [this](const RowScore& row) { return row.score < threshold_; });
    // With many equal vectors, prune less often, or the scan would be quadratic.
    limit_ = std::max(limit_, 2 * found_.size());
  }

  size_t k_, limit_;
  float margin_;
  float threshold_ = -std::numeric_limits<float>::infinity();
  std::vector<RowScore> found_;
};

/// scores [query_count][count] = queries * vectors^T
void score_rows(const float* vectors, int64_t count, int width, const float* queries,
                int64_t query_count, float* scores) {
  const auto rows = static_cast<int>(count), wanted = static_cast<int>(query_count);
  if (wanted == 1) {
    cblas_sgemv(CblasRowMajor, CblasNoTrans, rows, width, 1.f, vectors, width, queries, 1, 0.f,
                scores, 1);
  } else {
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasTrans, wanted, rows, width, 1.f, queries, width,
                vectors, width, 0.f, scores, rows);
  }
}

}  // namespace

std::vector<std::vector<RowScore>> exact_top_k(const float* vectors, int64_t count, int width,
                                               const RowChoice& choice, const float* queries,
                                               int64_t query_count, int64_t k) {
  const std::vector<int64_t>* rows = choice.rows;
  const int64_t available = rows ? static_cast<int64_t>(rows->size()) : count;
  k = std::min(k, available);
  std::vector<std::vector<RowScore>> results(static_cast<size_t>(query_count));
  if (k <= 0 || query_count == 0) return results;

  const int64_t batch = std::min(query_count, kMaxQueries);
  const int64_t block = std::min(available, rows ? kGatheredRows : kMaxScores / batch);
  std::vector<float> scores(static_cast<size_t>(batch * block));
  std::vector<float> gathered(rows ? static_cast<size_t>(block * width) : 0);

  for (int64_t query = 0; query < query_count; query += batch) {
    const int64_t in_batch = std::min(batch, query_count - query);
    const float* batch_queries = queries + query * width;
    std::vector<Candidates> candidates(static_cast<size_t>(in_batch),
                                       Candidates(k, score_margin(width)));
    for (int64_t first = 0; first < available; first += block) {
      const int64_t in_block = std::min(block, available - first);
      const float* source = vectors + first * width;
      if (rows) {
        for (int64_t i = 0; i < in_block; ++i) {
          const int64_t row = (*rows)[static_cast<size_t>(first + i)];
          std::copy_n(vectors + row * width, width, gathered.data() + i * width);
        }
        source = gathered.data();
      }
      score_rows(source, in_block, width, batch_queries, in_batch, scores.data());
      for (int64_t i = 0; i < in_batch; ++i) {
        candidates[static_cast<size_t>(i)].offer(scores.data() + i * in_block, in_block, first,
                                                 choice);
      }
    }
    for (int64_t i = 0; i < in_batch; ++i) {
      results[static_cast<size_t>(query + i)] =
          candidates[static_cast<size_t>(i)].finish(vectors, batch_queries + i * width, width);
    }
  }
  return results;
}

void require_unit_length(const float* vector, int width, const std::string& subject) {
  double square = 0;
  for (int i = 0; i < width; ++i) square += static_cast<double>(vector[i]) * vector[i];
  if (!(std::abs(std::sqrt(square) - 1) <= kNormTolerance)) {
    throw Error(fmt::format("{} has length {:.4g} instead of 1; normalise it (L2)", subject,
                            std::sqrt(square)));
  }
}

}  // namespace remomask::index
