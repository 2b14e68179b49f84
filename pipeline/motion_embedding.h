#pragma once

#include <vector>

#include "remomask/motion.h"
#include "retriever/retriever.h"

namespace remomask::pipeline {

/// Vector of any motion (22 joints, 20 fps) in the retriever's space: made
/// canonical, features of all frames in the retriever's mode, encoded. The same
/// way as the clips of a database. L2-normalised. Throws Error when the motion
/// has values that are not finite.
std::vector<float> embed_motion(const retriever::Retriever& retriever, const Motion& motion);

}  // namespace remomask::pipeline
