#pragma once

#include "motion/vector.h"
#include "remomask/skeleton.h"

namespace remomask::motion {

/// Smallest rotation that takes the direction `from` to the direction `to` (of any length; the
/// identity if one has no length). Between opposite directions it is a half turn around
/// `half_turn_axis`, made perpendicular to `from`.
inline Quat shortest_arc(const Vec3& from, const Vec3& to,
                         const Vec3& half_turn_axis = Vec3::UnitX()) {
  const double length = std::sqrt(from.squaredNorm() * to.squaredNorm());
  if (length < 1e-18) return Quat::Identity();
  const double w = length + from.dot(to);
  const Vec3 v = from.cross(to);
  if (w * w + v.squaredNorm() < 1e-18 * length * length) {
    Vec3 axis = half_turn_axis - from * (from.dot(half_turn_axis) / from.squaredNorm());
    if (axis.squaredNorm() < 1e-12) axis = from.unitOrthogonal();
    axis.normalize();
    return Quat(0, axis.x(), axis.y(), axis.z());
  }
  return Quat(w, v.x(), v.y(), v.z()).normalized();
}

/// Rotation by `angle` radians around +Y.
inline Quat yaw_rotation(double angle) {
  return Quat(std::cos(angle / 2), 0, std::sin(angle / 2), 0);
}

/// Writes the first two columns of the rotation matrix, one after the other.
inline void write_6d(const Quat& rotation, float* out) {
  const Eigen::Matrix3d m = rotation.toRotationMatrix();
  for (int column = 0; column < 2; ++column) {
    for (int row = 0; row < 3; ++row) out[column * 3 + row] = static_cast<float>(m(row, column));
  }
}

}  // namespace remomask::motion
