#include "evaluation/reconstruction_fid.h"

#include <algorithm>

#include "base/time.h"
#include "evaluation/generation_metrics.h"
#include "tokenizer/tokenizer_network.h"

namespace remomask::evaluation {

namespace {

at::Tensor embed_through_positions(const Evaluator& evaluator, const Skeleton& skeleton,
                                   const std::vector<motion::Features>& clips) {
  std::vector<motion::Features> features;
  std::vector<const motion::Features*> pointers;
  for (const motion::Features& clip : clips) {
    features.push_back(
        motion::extract_features(motion::recover_motion_with_next_frame(clip, skeleton), skeleton,
                                 evaluator.feature_mode()));
  }
  for (const motion::Features& one : features) pointers.push_back(&one);
  return evaluator.embed_motion(pointers);
}

}  // namespace

ReconstructionFid measure_reconstruction_fid(const Evaluator& evaluator,
                                             const tokenizer::Tokenizer& tokenizer,
                                             const std::vector<const motion::Features*>& clips) {
  const Skeleton& skeleton = skeleton_named(tokenizer.config().skeleton);
  std::vector<motion::Features> original;
  for (const motion::Features* clip : clips) {
    const int frames = clip->frames - clip->frames % static_cast<int>(kFramesPerToken);
    if (frames == 0) continue;
    motion::Features cut(frames, clip->dim);
    std::copy_n(clip->values.begin(), cut.values.size(), cut.values.begin());
    original.push_back(std::move(cut));
  }
  std::vector<const motion::Features*> pointers;
  for (const motion::Features& clip : original) pointers.push_back(&clip);
  std::vector<motion::Features> all_levels, base_level;
  for (const at::Tensor& tokens : tokenizer.encode(pointers)) {
    all_levels.push_back(tokenizer.decode(tokens));
    base_level.push_back(tokenizer.decode(tokens.narrow(2, 0, 1)));
  }
  const at::Tensor real = embed_through_positions(evaluator, skeleton, original);
  return {frechet_distance(real, embed_through_positions(evaluator, skeleton, all_levels)),
          frechet_distance(real, embed_through_positions(evaluator, skeleton, base_level))};
}

}  // namespace remomask::evaluation
