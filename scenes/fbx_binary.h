#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace remomask::scenes {

/// What assimp's FBX writer leaves out or gets wrong.
struct FbxFacts {
  double fps = 0;
  std::vector<double> seconds;  ///< length of every animation
};

/// A file of assimp's FBX writer that other readers understand. Every list of nodes gets the empty
/// record at its end that readers look for (assimp 5.2 leaves it out, and nothing opens its files),
/// the frame rate and the animations' ends (whole seconds there) are set, and angles do not jump by
/// full turns between keys. Throws Error for anything but binary FBX 7.5.
std::string complete_fbx(std::string_view bytes, const FbxFacts& facts);

}  // namespace remomask::scenes
