#pragma once

#include <string>
#include <vector>

#include "motion/vector.h"
#include "rig/source_motion.h"

namespace remomask::scenes {

/// A node's transform: scaled, then rotated, then moved.
struct NodeTransform {
  Vec3 translation = Vec3::Zero();
  Quat rotation = Quat::Identity();
  Vec3 scale = Vec3::Ones();
};

/// The keys of one property of one node.
struct NodeTrack {
  enum class Property { translation, rotation, scale };
  enum class Interpolation { step, linear, cubic_spline };

  int node = 0;
  Property property = Property::translation;
  Interpolation interpolation = Interpolation::linear;
  std::vector<float> times;
  std::vector<float> values;  ///< a key each; three for a cubic spline: tangent in, value, out

  /// Replaces the property in `transform` by its value at `time`.
  void apply(double time, NodeTransform& transform) const;

 private:
  Eigen::Vector4d value_at(double time) const;
};

struct NodeTimeline {
  std::string name;
  std::vector<NodeTrack> tracks;
  double begin = 0, end = 0;  ///< seconds

  /// Keys per second of the densest track; 30 where keys are sparse.
  double key_rate() const;
};

/// The rest pose of `motion.joints` from local transforms; scales go into the offsets.
void set_rest(const std::vector<NodeTransform>& rest, rig::SourceMotion& motion);

/// Samples a timeline at the rate of its keys. `joint_of` gives the joint of every node (-1: none),
/// `rest` the transforms of joints without keys. Joints stay where the scales put them. Throws
/// Error for an animation of endless length.
void add_frames(const NodeTimeline& timeline, const std::vector<int>& joint_of,
                const std::vector<NodeTransform>& rest, rig::SourceMotion& motion);

}  // namespace remomask::scenes
