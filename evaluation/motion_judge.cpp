#include "evaluation/motion_judge.h"

#include <fmt/format.h>
#include <torch/utils.h>

#include <algorithm>
#include <cmath>

#include "db/training_set.h"
#include "evaluation/evaluator_network.h"
#include "evaluation/tokenizer_metrics.h"
#include "nn/tensor_values.h"
#include "remomask/error.h"

namespace remomask::evaluation {

namespace {

class EvaluatorJudge : public MotionJudge {
 public:
  EvaluatorJudge(const Evaluator& evaluator, const db::Database& database) : evaluator_(evaluator) {
    db::TrainingSetOptions options;
    options.splits = {"train", "val", "test", "none"};
    options.add_mirrored = false;
    options.mode = evaluator.feature_mode();
    options.min_frames = static_cast<int>(kFramesPerMovement);
    const auto clips = db::load_training_set(database, options);
    for (const db::TrainingClip& clip : clips) clip_ids_.push_back(clip.clip_id);  // ascending
    vectors_ = evaluator.embed_motion(clip_features(clips));
  }

  std::string identity() const override { return "evaluator " + evaluator_.hash(); }
  const std::vector<int64_t>& clip_ids() const override { return clip_ids_; }

  std::vector<float> embed(const Motion& motion) const override {
    return nn::float_vector(evaluator_.embed_motion(motion));
  }

  std::optional<NearMotion> nearest(const std::vector<float>& vector,
                                    const std::vector<int64_t>& allowed) const override {
    std::vector<int64_t> rows;
    for (const int64_t id : allowed) {
      const auto found = std::lower_bound(clip_ids_.begin(), clip_ids_.end(), id);
      if (found != clip_ids_.end() && *found == id) rows.push_back(found - clip_ids_.begin());
    }
    if (rows.empty()) return std::nullopt;
    const at::Tensor distances =
        (vectors_.index_select(0, torch::tensor(rows, torch::kLong)) - torch::tensor(vector))
            .norm(2, 1);
    const int64_t best = distances.argmin().item<int64_t>();
    return NearMotion{clip_ids_[static_cast<size_t>(rows[static_cast<size_t>(best)])],
                      distances[best].item<double>()};
  }

 private:
  const Evaluator& evaluator_;
  std::vector<int64_t> clip_ids_;
  at::Tensor vectors_;
};

class RetrieverJudge : public MotionJudge {
 public:
  RetrieverJudge(const index::VectorIndex& index, EmbedMotion embed)
      : index_(index), embed_(std::move(embed)) {}

  std::string identity() const override { return "retriever " + index_.stamp().retriever_hash; }
  const std::vector<int64_t>& clip_ids() const override { return index_.clip_ids(); }
  std::vector<float> embed(const Motion& motion) const override { return embed_(motion); }

  std::optional<NearMotion> nearest(const std::vector<float>& vector,
                                    const std::vector<int64_t>& allowed) const override {
    if (static_cast<int>(vector.size()) != index_.width()) {
      throw Error(
          fmt::format("the motion's vector has {} numbers, those of the gallery {}; "
                      "use the same retriever for both",
                      vector.size(), index_.width()));
    }
    const auto hits = index_.search(vector.data(), 1, 1, &allowed).front();
    if (hits.empty()) return std::nullopt;
    // Vectors are L2-normalised.
    const double squared = 2 - 2 * static_cast<double>(hits.front().similarity);
    return NearMotion{hits.front().clip_id, std::sqrt(std::max(0.0, squared))};
  }

 private:
  const index::VectorIndex& index_;
  EmbedMotion embed_;
};

}  // namespace

std::unique_ptr<MotionJudge> evaluator_judge(const Evaluator& evaluator,
                                             const db::Database& database) {
  return std::make_unique<EvaluatorJudge>(evaluator, database);
}

std::unique_ptr<MotionJudge> retriever_judge(const index::VectorIndex& index, EmbedMotion embed) {
  return std::make_unique<RetrieverJudge>(index, std::move(embed));
}

}  // namespace remomask::evaluation
