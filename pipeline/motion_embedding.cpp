#include "pipeline/motion_embedding.h"

#include "motion/canonical.h"
#include "motion/features.h"
#include "nn/tensor_values.h"

namespace remomask::pipeline {

std::vector<float> embed_motion(const retriever::Retriever& retriever, const Motion& motion) {
  const Skeleton& skeleton = humanml_skeleton();
  const motion::Features features = motion::extract_features_all_frames(
      motion::canonicalize(motion, skeleton), skeleton, retriever.feature_mode());
  return nn::float_vector(retriever.encode_motion({&features}).global[0]);
}

}  // namespace remomask::pipeline
