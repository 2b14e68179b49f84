#include "remomask/motion.h"

#include <fmt/format.h>

#include <algorithm>

#include "remomask/error.h"

namespace remomask {

Motion slice(const Motion& motion, int first, int last) {
  if (first < 0 || last > motion.frames || first > last) {
    throw Error(fmt::format("frames {} to {} are outside the motion, which has {} frames", first,
                            last, motion.frames));
  }
  Motion part(last - first, motion.joints);
  part.fps = motion.fps;
  part.skeleton = motion.skeleton;
  const size_t row = static_cast<size_t>(motion.joints) * 3;
  std::copy(motion.positions.begin() + first * row, motion.positions.begin() + last * row,
            part.positions.begin());
  return part;
}

}  // namespace remomask
