#pragma once

#include <array>

#include "rig/rest_skeleton.h"

namespace remomask::rig {

/// Finds the pose of a rigid skeleton that is nearest to given joint positions.
///
/// Pelvis and chest of captured and generated motions deform, and so the joints of no rigid
/// skeleton meet them. The fit minimises the weighted squares of the distances, over all joints at
/// once, under the constraints that bones keep their lengths and that pelvis and chest keep their
/// shapes. Feet weigh so much that they stay in place, wrists and spine weigh more than the rest,
/// and joints that are left far from their place weigh more from round to round. It is a closed
/// function of one frame: what moves smoothly is fitted smoothly.
class RigidFit {
 public:
  explicit RigidFit(const RestSkeleton& rest);

  /// The pose nearest to `target`. All constraints are met to a micrometre.
  Pose fit(const Pose& target) const;

 private:
  static constexpr size_t kRods = 27;
  using Vector = std::array<double, kRods>;

  /// Two joints that keep their distance.
  struct Rod {
    size_t a = 0, b = 0;
    double length = 0;
  };
  /// A rod of a lower number that shares a joint with another.
  struct Neighbour {
    size_t rod = 0, joint = 0;
    double sign = 1;
  };
  struct State;

  Pose nearest_by_directions(const Pose& target) const;
  void measure(State& state) const;
  /// Moves the pose by `pull` under the linear constraints; the largest move of a joint.
  double step(State& state, const Pose& pull, double most) const;
  void solve(State& state, Vector& right) const;

  RestSkeleton rest_;
  std::array<Rod, kRods> rods_;
  std::array<std::array<Neighbour, 8>, kRods> neighbours_;
  std::array<size_t, kRods> neighbour_count_{}, first_{};
};

}  // namespace remomask::rig
