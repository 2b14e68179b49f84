#pragma once

#include "formats/bvh.h"
#include "rig/source_motion.h"

namespace remomask::formats {

/// The rest pose of a BVH file as a rig without frames.
rig::SourceMotion rest_of_bvh(const Bvh& bvh);

/// A motion of any skeleton as BVH. Rest rotations, which BVH cannot hold, go into the offsets: the
/// rest pose stays where it is, with axes along those of the world. Six channels where a joint
/// moves against its parent, three (Z Y X) elsewhere.
Bvh source_to_bvh(const rig::SourceMotion& source);

}  // namespace remomask::formats
