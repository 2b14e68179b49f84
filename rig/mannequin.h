#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "motion/vector.h"

namespace remomask::rig {

enum class Surface { body, accent };

/// A closed body of triangles that follows joints. Positions and normals are those of the T-pose,
/// metres, Y up, facing +Z.
struct SkinnedMesh {
  struct Part {
    Surface surface = Surface::body;
    std::vector<uint16_t> triangles;  ///< three vertices each, counter-clockwise from outside
  };
  std::vector<std::array<float, 3>> positions, normals;
  std::vector<std::array<uint8_t, 4>> joints;  ///< of the 22 joints; 0 where the weight is 0
  std::vector<std::array<float, 4>> weights;   ///< sum to 1
  std::vector<Part> parts;                     ///< one a surface
};

/// A low-poly figure in the proportions of a T-pose: `rest` holds the 22 joints in the order of
/// humanml_skeleton(). The soles lie at the height of the lower toe joint, where the floor is.
SkinnedMesh make_mannequin(const std::vector<Vec3>& rest);

}  // namespace remomask::rig
