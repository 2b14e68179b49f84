#include "tests/rig/rig_builder.h"

#include <algorithm>
#include <functional>
#include <stdexcept>

namespace remomask::testing_support {

namespace {

struct Placed {
  std::string name;
  int parent;
  Vec3 position;
};

/// The joints in the T-pose, parents first.
class RigPlacer {
 public:
  explicit RigPlacer(const RigNames& names) : names_(names) {
    int root = -1;
    for (const std::string& name : names.roots) root = add(name, root, Vec3::Zero());
    pelvis_ = add(names.pelvis, root, Vec3(0, 95, 0));
    for (int side = 0; side < 2; ++side) add_leg(side);
    add_trunk();
    for (const std::string& other : names.others) add_other(other);
  }

  std::vector<Placed> joints;
  std::map<std::string, Vec3> truth;

 private:
  int add(const std::string& name, int parent, const Vec3& position) {
    joints.push_back({name, parent, position});
    return static_cast<int>(joints.size()) - 1;
  }

  int add_limb(const std::string& pattern, int side, int parent, const Vec3& left,
               const std::string& ours) {
    if (pattern.empty()) return parent;
    const Vec3 position(side == 0 ? left.x() : -left.x(), left.y(), left.z());
    if (!ours.empty()) truth[(side == 0 ? "left_" : "right_") + ours] = position;
    return add(sided(pattern, side), parent, position);
  }

  void add_leg(int side) {
    const int hip = add_limb(names_.hip, side, pelvis_, Vec3(9, 89, 0), "hip");
    const int knee = add_limb(names_.knee, side, hip, Vec3(9.5, 49, 0.5), "knee");
    const int ankle = add_limb(names_.ankle, side, knee, Vec3(10, 8, -2), "ankle");
    add_limb(names_.toe, side, ankle, Vec3(10.5, 2, 12), "foot");
  }

  void add_trunk() {
    int above = pelvis_;
    const size_t count = names_.spine.size();
    for (size_t i = 0; i < count; ++i) {  // between the pelvis and the chest
      const double height = 95 + 36. * static_cast<double>(i + 1) / static_cast<double>(count + 1);
      above = add(names_.spine[i], above, Vec3(0, height + 5, -1));
    }
    const int chest = above;
    for (size_t i = 0; i < names_.necks.size(); ++i) {
      const Vec3 position(0, 148 + 4. * static_cast<double>(i), -1);
      if (i == 0) truth["neck"] = position;
      above = add(names_.necks[i], above, position);
    }
    if (!names_.head.empty()) {
      truth["head"] = Vec3(0, 158, 1);
      add(names_.head, above, truth["head"]);
    }
    for (int side = 0; side < 2; ++side) {
      int parent = chest;
      for (const std::string& collar : names_.collars) {
        parent = add_limb(collar, side, parent, Vec3(6, 141, 0),
                          &collar == &names_.collars.back() ? "collar" : "");
      }
      const int shoulder = add_limb(names_.shoulder, side, parent, Vec3(18, 142, -1), "shoulder");
      const int elbow = add_limb(names_.elbow, side, shoulder, Vec3(45, 142, -2), "elbow");
      add_limb(names_.wrist, side, elbow, Vec3(70, 142, -1), "wrist");
    }
  }

  void add_other(const std::string& other) {
    const size_t arrow = other.find('<');
    const int sides = other.find('{') == std::string::npos ? 1 : 2;
    for (int side = 0; side < sides; ++side) {
      const std::string name = sided(other.substr(0, arrow), side),
                        parent = sided(other.substr(arrow + 1), side);
      const auto found = std::find_if(joints.begin(), joints.end(),
                                      [&](const Placed& joint) { return joint.name == parent; });
      if (found == joints.end()) throw std::invalid_argument(parent);
      add(name, static_cast<int>(found - joints.begin()), found->position + Vec3(1, 2, 3));
    }
  }

  const RigNames& names_;
  int pelvis_ = 0;
};

std::vector<Placed> in_reverse_order(const std::vector<Placed>& joints) {
  std::vector<Placed> out;
  const std::function<void(int, int)> visit = [&](int joint, int parent) {
    out.push_back({joints[static_cast<size_t>(joint)].name, parent,
                   joints[static_cast<size_t>(joint)].position});
    const int here = static_cast<int>(out.size()) - 1;
    for (int child = static_cast<int>(joints.size()) - 1; child > joint; --child) {
      if (joints[static_cast<size_t>(child)].parent == joint) visit(child, here);
    }
  };
  visit(0, -1);
  return out;
}

}  // namespace

std::string sided(const std::string& pattern, int side) {
  const size_t open = pattern.find('{');
  if (open == std::string::npos) return pattern;
  const size_t bar = pattern.find('|', open), close = pattern.find('}', open);
  const std::string middle = side == 0 ? pattern.substr(open + 1, bar - open - 1)
                                       : pattern.substr(bar + 1, close - bar - 1);
  return pattern.substr(0, open) + middle + pattern.substr(close + 1);
}

BuiltRig build_rig(const RigNames& names, const RigOptions& options) {
  RigPlacer placer(names);
  if (options.reversed) placer.joints = in_reverse_order(placer.joints);
  BuiltRig built;
  built.truth = placer.truth;
  built.motion.frames = 1;
  built.motion.fps = 30;
  std::vector<Quat> world;
  for (size_t j = 0; j < placer.joints.size(); ++j) {
    const Placed& joint = placer.joints[j];
    const double turn = options.scrambled_rest ? 0.7 * static_cast<double>(j + 1) : 0;
    world.emplace_back(Eigen::AngleAxisd(turn, Vec3(1, 2, static_cast<double>(j)).normalized()));
    Vec3 offset = joint.position;
    Quat rotation = world[j];
    if (joint.parent >= 0) {
      const auto parent = static_cast<size_t>(joint.parent);
      offset = world[parent].conjugate() * (joint.position - placer.joints[parent].position);
      rotation = world[parent].conjugate() * world[j];
    }
    rig::SourceJoint out;
    out.name = joint.name;
    out.parent = joint.parent;
    if (!options.zero_offsets) out.offset = offset;
    built.motion.joints.push_back(out);
    for (int axis = 0; axis < 4; ++axis) {
      built.motion.rotations.push_back(static_cast<float>(rotation.coeffs()[axis]));
    }
    for (int axis = 0; axis < 3; ++axis) {
      built.motion.translations.push_back(static_cast<float>(offset[axis]));
    }
  }
  return built;
}

}  // namespace remomask::testing_support
