#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "db/database.h"
#include "evaluation/evaluator.h"
#include "index/vector_index.h"

namespace remomask::evaluation {

/// A real motion near another one.
struct NearMotion {
  int64_t clip_id = 0;
  double distance = 0;  ///< Euclidean, in the judge's space
};

/// Tells which real motion is nearest to any motion.
class MotionJudge {
 public:
  virtual ~MotionJudge() = default;
  /// What its answers depend on, for protocol stamps.
  virtual std::string identity() const = 0;
  /// Clips that it can name, ascending.
  virtual const std::vector<int64_t>& clip_ids() const = 0;
  /// Vector of a motion (22 joints, 20 fps).
  virtual std::vector<float> embed(const Motion& motion) const = 0;
  /// The nearest of the `allowed` clips (ascending); nothing when there are none.
  virtual std::optional<NearMotion> nearest(const std::vector<float>& vector,
                                            const std::vector<int64_t>& allowed) const = 0;
};

/// Vector of a motion; see embed_motion().
using EmbedMotion = std::function<std::vector<float>(const Motion& motion)>;

/// Judges in the evaluator's space, among all clips of a database that have at
/// least four frames. `evaluator` must outlive it.
std::unique_ptr<MotionJudge> evaluator_judge(const Evaluator& evaluator,
                                             const db::Database& database);

/// Judges in the retriever's space; `embed` must fit the vectors of `index`, which
/// must outlive it.
std::unique_ptr<MotionJudge> retriever_judge(const index::VectorIndex& index, EmbedMotion embed);

}  // namespace remomask::evaluation
