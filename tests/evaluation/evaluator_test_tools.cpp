#include "tests/evaluation/evaluator_test_tools.h"
#include "motion/vector.h"

#include <torch/utils.h>

#include "evaluation/evaluator_network.h"
#include "tests/retriever/retriever_test_tools.h"

namespace remomask {

evaluation::EvaluatorConfig tiny_evaluator_config() {
  evaluation::EvaluatorConfig config = evaluation::evaluator_preset(ModelSize::tiny);
  std::vector<std::string> captions;
  for (const db::TrainingClip& clip : separable_clips(24, 2, 1))
    captions.push_back(clip.captions[0]);
  config.vocabulary = evaluation::evaluator_vocabulary(captions);
  return config;
}

nn::ModelStage untrained_evaluator_stage(uint64_t seed) {
  torch::manual_seed(seed);
  const evaluation::EvaluatorConfig config = tiny_evaluator_config();
  return {"evaluator", config, nn::module_tensors(*evaluation::EvaluatorNetwork(config))};
}

Motion standing_body(int frames) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion motion(frames, skeleton.joints());
  const double hip_height = skeleton.bone_lengths[4] + skeleton.bone_lengths[7];
  std::vector<Vec3> joints(static_cast<size_t>(skeleton.joints()), Vec3(0, hip_height, 0));
  for (size_t joint = 1; joint < joints.size(); ++joint) {
    joints[joint] = joints[static_cast<size_t>(skeleton.parents[joint])] +
                    skeleton.bone_lengths[joint] * rest_direction(skeleton, joint);
  }
  for (int frame = 0; frame < frames; ++frame) {
    for (int joint = 0; joint < motion.joints; ++joint) {
      set_joint_position(motion, frame, joint, joints[static_cast<size_t>(joint)]);
    }
  }
  return motion;
}

}  // namespace remomask
