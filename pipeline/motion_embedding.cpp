#include "pipeline/motion_embedding.h"

#include "motion/canonical.h"
#include "motion/features.h"

namespace remomask::pipeline {

std::vector<float> embed_motion(const retriever::Retriever& retriever, const Motion& motion) {
  const Skeleton& skeleton = humanml_skeleton();
  const motion::Features features = motion::extract_features_all_frames(
      motion::canonicalize(motion, skeleton), skeleton, retriever.feature_mode());
  const at::Tensor vector =
      retriever.encode_motion({&features}).global[0].to(at::kCPU, at::kFloat).contiguous();
  return {vector.data_ptr<float>(), vector.data_ptr<float>() + vector.numel()};
}

}  // namespace remomask::pipeline
