#include "tests/evaluation/evaluator_test_tools.h"

#include <torch/utils.h>

#include "evaluation/evaluator_network.h"
#include "tests/retriever/retriever_test_tools.h"

namespace remomask {

EvaluatorConfig tiny_evaluator_config() {
  EvaluatorConfig config = evaluator_preset("tiny");
  std::vector<std::string> captions;
  for (const TrainingClip& clip : separable_clips(24, 2, 1)) captions.push_back(clip.captions[0]);
  config.vocabulary = evaluator_vocabulary(captions);
  return config;
}

ModelStage untrained_evaluator_stage(uint64_t seed) {
  torch::manual_seed(seed);
  const EvaluatorConfig config = tiny_evaluator_config();
  return {"evaluator", config, module_tensors(*EvaluatorNetwork(config))};
}

Motion standing_body(int frames) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion motion(frames, skeleton.joints());
  const double hip_height = skeleton.bone_lengths[4] + skeleton.bone_lengths[7];
  std::vector<Vec3> joints(static_cast<size_t>(skeleton.joints()), Vec3(0, hip_height, 0));
  for (size_t joint = 1; joint < joints.size(); ++joint) {
    joints[joint] = joints[static_cast<size_t>(skeleton.parents[joint])] +
                    skeleton.bone_lengths[joint] * skeleton.rest_directions[joint];
  }
  for (int frame = 0; frame < frames; ++frame) {
    for (int joint = 0; joint < motion.joints; ++joint) {
      motion.set(frame, joint, joints[static_cast<size_t>(joint)]);
    }
  }
  return motion;
}

}  // namespace remomask
