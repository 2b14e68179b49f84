#pragma once

#include <string>
#include <vector>

#include "formats/motion_reading.h"
#include "rig/source_motion.h"

namespace remomask::formats {

/// The skeleton that hangs on the joint `root`, alone. Throws FileError that names the roots of the
/// file if there is none of this name. A root inside of another tree is found, too.
rig::SourceMotion keep_skeleton(const rig::SourceMotion& source, const std::string& root,
                                const std::string& path);

/// The 22 joints of a skeleton with its motion, found by the map that the options name or by rule.
/// Every reader that gives a SourceMotion ends here. Throws FileError if the joints are not found.
RawMotion load_source_motion(const rig::SourceMotion& source, const std::string& path,
                             const MotionFileOptions& options);

}  // namespace remomask::formats
