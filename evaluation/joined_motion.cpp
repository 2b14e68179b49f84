#include "evaluation/joined_motion.h"
#include "motion/vector.h"

#include <algorithm>
#include <cmath>

#include "motion/heading.h"
#include "motion/rotation.h"
#include "remomask/error.h"

namespace remomask::evaluation {

namespace {

double facing_angle(const Motion& motion, int frame, const Skeleton& skeleton) {
  const Vec3 forward = Vec3::UnitY().cross(motion::across_body(motion, frame, skeleton));
  return std::atan2(forward.x(), forward.z());
}

}  // namespace

Motion join_motions(const std::vector<Motion>& motions, const Skeleton& skeleton, int fade) {
  int frames = 0;
  for (const Motion& motion : motions) {
    if (motion.frames < 1 || motion.joints != skeleton.joints()) {
      throw Error("only motions with frames and of one skeleton can be joined");
    }
    frames += motion.frames;
  }
  if (motions.empty()) throw Error("there are no motions to join");
  Motion result(frames, skeleton.joints());
  int first = 0;
  for (const Motion& motion : motions) {
    Quat turn = Quat::Identity();
    Vec3 shift = Vec3::Zero();
    std::vector<Vec3> offsets(static_cast<size_t>(skeleton.joints()), Vec3::Zero());
    if (first > 0) {
      turn = motion::yaw_rotation(facing_angle(result, first - 1, skeleton) -
                                  facing_angle(motion, 0, skeleton));
      shift = joint_position(result, first - 1, 0) - turn * joint_position(motion, 0, 0);
      shift.y() = 0;
      for (int j = 0; j < skeleton.joints(); ++j) {
        offsets[static_cast<size_t>(j)] =
            joint_position(result, first - 1, j) - (turn * joint_position(motion, 0, j) + shift);
      }
    }
    for (int t = 0; t < motion.frames; ++t) {
      const double weight = std::max(0.0, 1 - static_cast<double>(t + 1) / (fade + 1));
      for (int j = 0; j < skeleton.joints(); ++j) {
        set_joint_position(
            result, first + t, j,
            turn * joint_position(motion, t, j) + shift + weight * offsets[static_cast<size_t>(j)]);
      }
    }
    first += motion.frames;
  }
  return result;
}

}  // namespace remomask::evaluation
