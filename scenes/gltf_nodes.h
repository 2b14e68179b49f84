#pragma once

#include <vector>

#include "scenes/gltf_document.h"
#include "scenes/node_motion.h"

namespace remomask::scenes {

/// The node tree of a file.
struct GltfNodes {
  std::vector<int> parents;  ///< -1 for a root
  std::vector<int> order;    ///< parents before children
  std::vector<NodeTransform> rest;
};

/// Throws FileError for cycles, nodes with two parents and rotations without length.
GltfNodes read_gltf_nodes(const GltfDocument& document);

/// Splits a column-major 4 x 4 matrix. A mirrored one gets a negative scale in x.
NodeTransform split_matrix(const double* matrix);

}  // namespace remomask::scenes
