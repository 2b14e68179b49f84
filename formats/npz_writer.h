#pragma once

#include <string>

#include "remomask/rotations.h"

namespace remomask::formats {

/// The layout of AMASS (SMPL-H, Z up, axis angles): trans, poses, root_orient, pose_body, pose_hand
/// (zeros), betas (zeros), gender, mocap_framerate. The rotations are those over our own skeleton
/// (23 joints, as rig::rotations_to_write() gives them); the key `approximated` says so.
std::string write_amass_npz(const JointRotations& motion);

/// positions, rotations, root, contacts, joint_names, parents, rest_offsets,
/// fps: metres, Y up. Positions are those of the 22 joints, rotations those of 23 with the root
/// joint.
std::string write_motion_npz(const JointRotations& motion);

}  // namespace remomask::formats
