#pragma once

#include <string>
#include <vector>

#include "formats/motion_reading.h"
#include "rig/source_motion.h"

namespace remomask::formats {

/// A motion as AMASS stores it: poses of an SMPL-like body as axis-angle rotations of its joints.
struct AmassMotion {
  /// The 22 joints by the names of humanml_skeleton(), over smpl_rest_offsets(); rate, unit and up
  /// axis where the file tells them.
  rig::SourceMotion source;
  std::vector<std::string> warnings;
};

/// Reads an .npz file with `poses` (SMPL, SMPL-H or SMPL-X) or `root_orient` and `pose_body`, with
/// `trans` and the rate in `mocap_framerate` or `mocap_frame_rate`. Throws FileError for others.
AmassMotion read_amass(const std::string& path);

/// Reads an .npz file: arrays of joint positions (`joints`, `positions`, ...) in the shapes of
/// motion_of_array(), or poses as AMASS stores them.
RawMotion read_npz_motion(const std::string& path);

}  // namespace remomask::formats
