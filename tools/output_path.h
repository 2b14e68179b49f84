#pragma once

#include <string>

namespace remomask::tools {

/// Before minutes of work: can a motion be stored there at all? Throws Error for
/// an ending other than .bvh and .npy, and for a folder that does not exist.
void require_writable_output(const std::string& output);

/// The output of sample `i` of `count`: NAME.bvh, or NAME-1.bvh, NAME-2.bvh ...
std::string sample_path(const std::string& output, int i, int count);

}  // namespace remomask::tools
