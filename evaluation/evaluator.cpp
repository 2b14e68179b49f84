#include "evaluation/evaluator.h"

#include <torch/utils.h>

#include <algorithm>
#include <numeric>

#include "evaluation/evaluator_network.h"
#include "evaluation/t2m_evaluator.h"
#include "motion/canonical.h"
#include "remomask/error.h"

namespace remomask::evaluation {

namespace {

constexpr size_t kEmbeddingBatch = 64;

/// Row i of the result is row order[i] of `rows`, put back to place order[i].
at::Tensor in_original_order(const at::Tensor& rows, const std::vector<int64_t>& order) {
  at::Tensor result = torch::empty_like(rows);
  result.index_copy_(0, torch::tensor(order, torch::kLong), rows);
  return result;
}

}  // namespace

struct Evaluator::Impl {
  EvaluatorNetwork network = nullptr;
  std::string hash;
};

Evaluator::Evaluator(const nn::ModelStage& stage) : impl_(std::make_unique<Impl>()) {
  if (stage.kind != "evaluator") {
    throw Error("this is no evaluator but a " + stage.kind + "; name a file with an evaluator");
  }
  EvaluatorConfig config;
  try {
    config = stage.config.get<EvaluatorConfig>();
  } catch (const nlohmann::json::exception& error) {
    throw Error(std::string("the evaluator's config is broken: ") + error.what());
  }
  impl_->network = EvaluatorNetwork(config);
  nn::load_module_tensors(*impl_->network, stage.tensors, "evaluator");
  impl_->network->eval();
  impl_->hash = nn::stage_hash(stage);
}

Evaluator::~Evaluator() = default;
Evaluator::Evaluator(Evaluator&&) noexcept = default;
Evaluator& Evaluator::operator=(Evaluator&&) noexcept = default;

const EvaluatorConfig& Evaluator::config() const { return impl_->network->config(); }

const std::string& Evaluator::hash() const { return impl_->hash; }

at::Tensor Evaluator::embed_text(const std::vector<std::string>& captions) const {
  at::NoGradGuard no_grad;
  std::vector<at::Tensor> parts;
  for (size_t first = 0; first < captions.size(); first += kEmbeddingBatch) {
    const size_t last = std::min(captions.size(), first + kEmbeddingBatch);
    const std::vector<std::string> part(captions.begin() + static_cast<std::ptrdiff_t>(first),
                                        captions.begin() + static_cast<std::ptrdiff_t>(last));
    parts.push_back(impl_->network->embed_text(impl_->network->words().encode(part)));
  }
  return parts.empty() ? torch::zeros({0, config().embedding}) : torch::cat(parts);
}

at::Tensor Evaluator::embed_motion(const std::vector<const motion::Features*>& motions) const {
  at::NoGradGuard no_grad;
  // Similar lengths together: less padding.
  std::vector<int64_t> order(motions.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int64_t a, int64_t b) {
    return motions[static_cast<size_t>(a)]->frames < motions[static_cast<size_t>(b)]->frames;
  });
  std::vector<at::Tensor> parts;
  for (size_t first = 0; first < order.size(); first += kEmbeddingBatch) {
    std::vector<EvaluatorCrop> crops;
    for (size_t i = first; i < std::min(order.size(), first + kEmbeddingBatch); ++i) {
      const motion::Features* features = motions[static_cast<size_t>(order[i])];
      crops.push_back({features, 0, features->frames});
    }
    parts.push_back(impl_->network->embed_motion(impl_->network->batch(crops)));
  }
  if (parts.empty()) return torch::zeros({0, config().embedding});
  return in_original_order(torch::cat(parts), order);
}

at::Tensor Evaluator::embed_motion(const Motion& motion) const {
  const Skeleton& skeleton = humanml_skeleton();
  const motion::Features features = motion::extract_features_all_frames(
      motion::canonicalize(motion, skeleton), skeleton, feature_mode());
  return embed_motion(std::vector<const motion::Features*>{&features})[0];
}

Evaluator load_evaluator(const std::string& path) {
  const nn::TensorFile file = nn::load_safetensors(path);
  return Evaluator(is_t2m_evaluator(file) ? import_t2m_evaluator(file, path)
                                          : nn::load_stage(path, "evaluator"));
}

}  // namespace remomask::evaluation
