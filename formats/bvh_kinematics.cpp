#include <cmath>
#include <numbers>

#include "formats/bvh.h"

namespace remomask::formats {

namespace {

// matrix <- matrix * rotation about one axis, which mixes two columns.
void turn_about_axis(double* matrix, int axis, double degrees) {
  const double angle = degrees * (std::numbers::pi / 180);
  const double c = std::cos(angle), s = std::sin(angle);
  const int first = (axis + 1) % 3, second = (axis + 2) % 3;
  for (int row = 0; row < 3; ++row) {
    double& a = matrix[row * 3 + first];
    double& b = matrix[row * 3 + second];
    const double old = a;
    a = c * old + s * b;
    b = c * b - s * old;
  }
}

void transform_point(const double* matrix, const double* origin, const double* local, double* out) {
  for (int row = 0; row < 3; ++row) {
    out[row] = origin[row] + matrix[row * 3] * local[0] + matrix[row * 3 + 1] * local[1] +
               matrix[row * 3 + 2] * local[2];
  }
}

}  // namespace

int Bvh::find_joint(std::string_view name) const {
  for (size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].name == name) return static_cast<int>(j);
  }
  return -1;
}

BvhKinematics::BvhKinematics(const Bvh& bvh, std::vector<BvhPoint> points)
    : bvh_(bvh), points_(std::move(points)), world_(bvh.joints.size()) {
  std::vector<bool> wanted(bvh.joints.size(), false);
  for (const BvhPoint& point : points_) {
    for (int j = point.joint; j >= 0 && !wanted[j]; j = bvh.joints[j].parent) wanted[j] = true;
  }
  for (size_t j = 0; j < wanted.size(); ++j) {
    if (wanted[j]) needed_.push_back(static_cast<int>(j));
  }
}

void BvhKinematics::solve(const float* channel_values) {
  static constexpr Transform kIdentity = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}};
  for (const int j : needed_) {
    const BvhJoint& joint = bvh_.joints[j];
    Transform& world = world_[j];
    const Transform& parent = joint.parent < 0 ? kIdentity : world_[joint.parent];
    double local[3] = {joint.offset.x(), joint.offset.y(), joint.offset.z()};
    std::copy(parent.matrix, parent.matrix + 9, world.matrix);
    if (channel_values) {
      const float* value = channel_values + joint.first_channel;
      for (const BvhChannel channel : joint.channels) {
        if (channel < 3) {
          local[channel] = *value++;
        } else {
          turn_about_axis(world.matrix, channel - 3, *value++);
        }
      }
    }
    transform_point(parent.matrix, parent.origin, local, world.origin);
  }
}

void BvhKinematics::write_points(float* out) const {
  for (const BvhPoint& point : points_) {
    const Transform& world = world_[point.joint];
    const double local[3] = {point.offset.x(), point.offset.y(), point.offset.z()};
    double position[3] = {};
    transform_point(world.matrix, world.origin, local, position);
    for (int axis = 0; axis < 3; ++axis) *out++ = static_cast<float>(position[axis]);
  }
}

void BvhKinematics::positions(int frame, float* out) {
  solve(bvh_.values.data() + static_cast<size_t>(frame) * bvh_.channels);
  write_points(out);
}

void BvhKinematics::rest_positions(float* out) {
  solve(nullptr);
  write_points(out);
}

}  // namespace remomask::formats
