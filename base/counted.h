#pragma once

#include <cstdint>
#include <string>

namespace remomask {

/// A number with its noun: "1 frame", "3 frames".
inline std::string counted(int64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace remomask
