#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "motion/vector.h"
#include "remomask/skeleton.h"

namespace remomask::formats {

/// Channel of a BVH joint: 0, 1, 2 position x, y, z; 3, 4, 5 rotation about x, y, z.
using BvhChannel = unsigned char;

struct BvhJoint {
  std::string name;
  int parent = -1;
  Vec3 offset = Vec3::Zero();
  std::vector<BvhChannel> channels;  ///< in the order of the CHANNELS line
  int first_channel = 0;             ///< column of the first of them
  std::optional<Vec3> end_site;
};

/// A BVH file: the hierarchy (parents first) and one row of channel values per frame, in the file's
/// units and in degrees.
struct Bvh {
  std::vector<BvhJoint> joints;
  int channels = 0;
  int frames = 0;
  double frame_time = 0;      ///< seconds
  std::vector<float> values;  ///< [frames][channels]
  /// What the reader met that it should not have, and what it made of it: "PATH:LINE: sentence".
  std::vector<std::string> warnings;

  int find_joint(std::string_view name) const;  ///< -1 if absent
};

struct BvhReading {
  /// Name of the root joint of the skeleton to read, where a file holds several.
  std::string root = {};
  /// The caller knows the frame rate: a Frame Time that is missing or impossible becomes 0.
  bool frame_time_known = false;
};

/// Reads a BVH file of any hierarchy, channel order and frame rate, in UTF-8 or UTF-16, as
/// tolerantly as Blender does: keywords in any case, any line ends, scale channels (left out), a
/// wrong number of frames, joints of the same name (renamed). Throws FileError with the line of
/// anything malformed, cut off inside a frame or not finite. Memory is bounded by the size of the
/// file, which may have 1 GiB.
Bvh read_bvh(const std::string& path, const BvhReading& reading = {});

/// The same from text; `path` only appears in messages.
Bvh parse_bvh(std::string_view text, const std::string& path, const BvhReading& reading = {});

/// Formats as BVH text (six decimals).
std::string format_bvh(const Bvh& bvh);

/// A point that moves with a joint, at `offset` in the joint's own axes. A zero offset is the joint
/// itself; the OFFSET of its End Site is the End Site.
struct BvhPoint {
  int joint = 0;
  Vec3 offset = Vec3::Zero();
};

/// Forward kinematics of some points; only their ancestors are computed.
/// Position channels replace the joint's OFFSET, axis by axis, as in Blender.
class BvhKinematics {
 public:
  BvhKinematics(const Bvh& bvh, std::vector<BvhPoint> points);
  /// World positions of the points in `frame`: points x 3 floats.
  void positions(int frame, float* out);
  /// The same for the rest pose: zero rotations, OFFSETs as they are.
  void rest_positions(float* out);

 private:
  struct Transform {
    double matrix[9];  // row-major
    double origin[3];
  };
  void solve(const float* channel_values);
  void write_points(float* out) const;

  const Bvh& bvh_;
  std::vector<BvhPoint> points_;
  std::vector<int> needed_;
  std::vector<Transform> world_;
};

}  // namespace remomask::formats
