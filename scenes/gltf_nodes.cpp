#include "scenes/gltf_nodes.h"

#include <fmt/format.h>

namespace remomask::scenes {

namespace {

constexpr size_t kMaxNodes = 100'000;

NodeTransform transform_of(const GltfDocument& document, const nlohmann::json& node,
                           size_t number) {
  if (node.contains("matrix")) {
    const std::vector<double> matrix = document.numbers(node, "matrix", 16, {});
    return split_matrix(matrix.data());
  }
  NodeTransform result;
  result.translation = Vec3(document.numbers(node, "translation", 3, {0, 0, 0}).data());
  const std::vector<double> q = document.numbers(node, "rotation", 4, {0, 0, 0, 1});
  result.rotation = Quat(q[3], q[0], q[1], q[2]);
  if (result.rotation.norm() < 1e-6) {
    document.fail(fmt::format("nodes[{}].rotation has no length", number));
  }
  result.rotation.normalize();
  result.scale = Vec3(document.numbers(node, "scale", 3, {1, 1, 1}).data());
  return result;
}

std::vector<int> children_of_node(const GltfDocument& document, const nlohmann::json& node,
                                  size_t number, size_t count) {
  std::vector<int> children;
  const auto found = node.find("children");
  if (found == node.end()) return children;
  if (!found->is_array()) document.fail(fmt::format("nodes[{}].children is not an array", number));
  for (const nlohmann::json& child : *found) {
    if (!child.is_number_unsigned() || child.get<uint64_t>() >= count) {
      document.fail(fmt::format("nodes[{}].children names a node that does not exist", number));
    }
    children.push_back(static_cast<int>(child.get<uint64_t>()));
  }
  return children;
}

}  // namespace

NodeTransform split_matrix(const double* matrix) {
  const Eigen::Map<const Eigen::Matrix4d> all(matrix);
  NodeTransform result;
  result.translation = all.block<3, 1>(0, 3);
  Eigen::Matrix3d linear = all.block<3, 3>(0, 0);
  for (int axis = 0; axis < 3; ++axis) {
    result.scale[axis] = linear.col(axis).norm();
    if (result.scale[axis] > 1e-12) linear.col(axis) /= result.scale[axis];
  }
  if (linear.determinant() < 0) {
    result.scale.x() *= -1;
    linear.col(0) *= -1;
  }
  result.rotation = Quat(linear);
  if (!(result.rotation.norm() > 1e-6)) result.rotation = Quat::Identity();
  result.rotation.normalize();
  return result;
}

GltfNodes read_gltf_nodes(const GltfDocument& document) {
  const size_t count = document.list("nodes").size();
  if (count > kMaxNodes) document.fail(fmt::format("has {} nodes, too many for a rig", count));
  GltfNodes nodes;
  nodes.parents.assign(count, -1);
  std::vector<std::vector<int>> children(count);
  for (size_t i = 0; i < count; ++i) {
    const nlohmann::json& node = document.element("nodes", i);
    nodes.rest.push_back(transform_of(document, node, i));
    children[i] = children_of_node(document, node, i, count);
    for (const int child : children[i]) {
      int& parent = nodes.parents[static_cast<size_t>(child)];
      if (parent >= 0) document.fail(fmt::format("nodes[{}] has two parents", child));
      parent = static_cast<int>(i);
    }
  }
  std::vector<int> waiting;
  for (size_t i = count; i-- > 0;) {
    if (nodes.parents[i] < 0) waiting.push_back(static_cast<int>(i));
  }
  while (!waiting.empty()) {
    const int node = waiting.back();
    waiting.pop_back();
    nodes.order.push_back(node);
    const std::vector<int>& below = children[static_cast<size_t>(node)];
    waiting.insert(waiting.end(), below.rbegin(), below.rend());
  }
  // With one parent each, only nodes of a cycle cannot be reached from a root.
  if (nodes.order.size() != count) document.fail("has nodes that are their own ancestors");
  return nodes;
}

}  // namespace remomask::scenes
