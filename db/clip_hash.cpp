#include "db/clip_hash.h"

#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/hash.h"
#include "remomask/error.h"

namespace remomask::db {

std::string clip_content_hash(const Motion& motion) {
  std::vector<int64_t> rounded;
  rounded.reserve(motion.positions.size() + 2);
  rounded.push_back(motion.frames);
  rounded.push_back(motion.joints);
  for (const float value : motion.positions) {
    // Also keeps llround within its range.
    if (!(std::abs(value) < 1e9f)) throw Error("a joint position is not a finite number");
    rounded.push_back(std::llround(static_cast<double>(value) * 1e4));
  }
  return content_hash(std::string_view(reinterpret_cast<const char*>(rounded.data()),
                                       rounded.size() * sizeof(int64_t)));
}

}  // namespace remomask::db
