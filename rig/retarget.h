#pragma once

#include <array>

#include "kinematics/foot_anchor.h"
#include "remomask/rotations.h"
#include "rig/skeleton_map.h"
#include "rig/source_motion.h"

namespace remomask::rig {

/// The joint of a rig that is each of the 22; -1 where it has none of its own.
using BodyJoints = std::array<int, 22>;

/// The joints that a map names as they are; points between joints and ends of bones are no joints.
/// Throws Error if pelvis, hips, knees, ankles, shoulders or elbows are among them.
BodyJoints body_joints(const SkeletonMap& map, const SkeletonView& rig);

/// A motion on somebody else's skeleton: the rig's joints, names and rest pose, with frames. Every
/// bone points where it does in `motion` (22 joints), whatever pose the rig rests in: an A-pose
/// becomes a T-pose first, and feet stay as flat as they rest. The path is scaled by the length of
/// the legs, ankles get the rig's own height over the floor, and feet that stand (`contacts`, a
/// pair a frame) do not slide. Joints that are none of the 22 stay at rest.
SourceMotion retarget(const JointRotations& motion, const SourceMotion& rig, const BodyJoints& body,
                      const kinematics::FootContacts& contacts);

}  // namespace remomask::rig
