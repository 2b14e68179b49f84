#include "rig/written_rotations.h"

#include "rig/joint_names.h"
#include "rig/loop.h"
#include "rig/resample_rotations.h"
#include "rig/root_motion.h"

namespace remomask::rig {

RotationsToWrite rotations_to_write(const Motion& motion, const MotionWriteOptions& options,
                                    JointNames names) {
  RotationsToWrite result;
  JointRotations solved = solve_rotations(
      motion, {.own_proportions = options.own_proportions, .keep_rigid = !options.common_skeleton});
  // The way over the ground goes last, since the loop needs to see which feet stand.
  if (options.loop) result.written.loop = close_loop(solved);
  if (options.in_place) keep_in_place(solved);
  if (options.fps) solved = resample_rotations(solved, *options.fps);
  result.motion = with_root_joint(solved, options.root_motion);
  const NamePreset& preset = name_preset(options.names.value_or(names));
  result.motion.joint_names = {std::string(preset.root)};
  result.motion.joint_names.insert(result.motion.joint_names.end(), preset.joints.begin(),
                                   preset.joints.end());
  result.written.frames = result.motion.frames;
  result.written.fps = result.motion.fps;
  return result;
}

}  // namespace remomask::rig
