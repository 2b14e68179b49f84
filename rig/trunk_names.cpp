#include "rig/trunk_names.h"

#include <algorithm>

namespace remomask::rig {

namespace {

/// Searches the trunk between limbs that are known.
class TrunkFinder {
 public:
  TrunkFinder(const SkeletonView& skeleton, const std::vector<NameReading>& names, Humanoid& body)
      : skeleton_(skeleton), names_(names), body_(body) {}

  void find() {
    const auto first = [](const LimbJoints& arm) {
      return arm[kCollar] >= 0 ? arm[kCollar] : arm[kShoulder];
    };
    legs_ = ancestor(body_.legs[0][kHip], body_.legs[1][kHip]);
    arms_ = ancestor(first(body_.arms[0]), first(body_.arms[1]));
    body_.pelvis = find_pelvis();
    if (body_.pelvis < 0) return;
    std::vector<int> necks = named(BodyPart::neck);
    body_.head = find_head(necks);
    find_spine(necks);
  }

 private:
  const NameReading& name(int joint) const { return names_[static_cast<size_t>(joint)]; }
  int depth(int joint) const { return static_cast<int>(skeleton_.path_to_root(joint).size()); }

  int ancestor(int a, int b) const {
    return a < 0 || b < 0 ? -1 : common_ancestor(skeleton_, a, b);
  }

  /// Joints in the middle of the body with a name for `part`, from the root outwards.
  std::vector<int> named(BodyPart part) const {
    std::vector<int> joints;
    for (size_t j = 0; j < skeleton_.size(); ++j) {
      const NameReading& reading = names_[j];
      if (reading.part == part && reading.side == Side::none && !reading.helper && !reading.end &&
          reading.strange_words < 2) {
        joints.push_back(static_cast<int>(j));
      }
    }
    std::stable_sort(joints.begin(), joints.end(), [&](int a, int b) {
      if (depth(a) != depth(b)) return depth(a) < depth(b);
      return name(a).number < name(b).number;
    });
    return joints;
  }

  /// Where both legs hang, unless a joint above it bears the name of the pelvis.
  int find_pelvis() const {
    const std::vector<int> pelvises = named(BodyPart::pelvis);
    if (legs_ >= 0 && name(legs_).part == BodyPart::pelvis) return legs_;
    int best = -1;
    for (const int joint : pelvises) {
      if (legs_ >= 0 && is_above(skeleton_, joint, legs_)) best = joint;
    }
    if (best >= 0) return best;
    // A root that holds the legs beside the pelvis, as flat lists of joints do.
    if (!pelvises.empty() && (legs_ < 0 || skeleton_.parents[static_cast<size_t>(legs_)] < 0)) {
      return pelvises[0];
    }
    const std::vector<int> spine = named(BodyPart::spine);  // Rigify calls the pelvis "spine"
    if (legs_ >= 0 && (spine.empty() || is_near_hips(legs_))) return legs_;
    return spine.empty() ? -1 : spine[0];
  }

  /// Not farther from the hips than a knee is.
  bool is_near_hips(int joint) const {
    const std::vector<Vec3>& p = skeleton_.first.positions;
    const LimbJoints &left = body_.legs[0], &right = body_.legs[1];
    if (left[kHip] < 0 || right[kHip] < 0 || left[kKnee] < 0) return true;
    const Vec3 hips = (p[at(left[kHip])] + p[at(right[kHip])]) / 2;
    return (p[at(joint)] - hips).norm() <= (p[at(left[kKnee])] - p[at(left[kHip])]).norm();
  }

  bool is_limb(int joint) const {
    for (const auto* limbs : {&body_.legs, &body_.arms}) {
      for (const LimbJoints& limb : *limbs) {
        if (std::find(limb.begin(), limb.end(), joint) != limb.end()) return true;
      }
    }
    return false;
  }

  /// Whether a limb hangs under the joint.
  bool holds_limb(int joint) const {
    for (const auto* limbs : {&body_.legs, &body_.arms}) {
      for (const LimbJoints& limb : *limbs) {
        for (const int part : limb) {
          if (part >= 0 && is_above(skeleton_, joint, part)) return true;
        }
      }
    }
    return false;
  }

  /// The child that continues the trunk upwards: of the middle, no helper, without a limb.
  int continuation(int joint) const {
    for (size_t j = 0; j < skeleton_.size(); ++j) {
      const NameReading& reading = names_[j];
      const int child = static_cast<int>(j);
      if (skeleton_.parents[j] == joint && reading.side == Side::none && !reading.helper &&
          !reading.end && !reading.tail && !holds_limb(child)) {
        return child;
      }
    }
    return -1;
  }

  int find_head(std::vector<int>& necks) const {
    const std::vector<int> heads = named(BodyPart::head);
    for (const int head : heads) {
      if (!is_limb(head) && head != body_.pelvis) return head;
    }
    if (!necks.empty()) {
      const int head = continuation(necks.back());
      if (head >= 0) return head;
      return -1;  // the End Site of the neck stands for it
    }
    // Neither neck nor head: what goes on above the arms, the last joint being the head.
    if (arms_ < 0) return -1;
    std::vector<int> above;
    // In a flat list nothing goes on; Rigify numbers the spine up to the head.
    const std::vector<int> spine = named(BodyPart::spine);
    if (arms_ == legs_ && spine.size() > 3) {
      necks = {spine[spine.size() - 2]};
      return spine.back();
    }
    for (int joint = continuation(arms_); joint >= 0; joint = continuation(joint)) {
      above.push_back(joint);
    }
    if (above.empty()) return -1;
    const int head = above.back();
    above.pop_back();
    necks = above;
    return head;
  }

  void find_spine(const std::vector<int>& necks) {
    int top = body_.head;
    if (!necks.empty()) body_.neck = top = necks[0];
    if (top < 0) return;
    const int meeting = common_ancestor(skeleton_, body_.pelvis, top);
    std::vector<int> between;
    for (int joint = skeleton_.parents[static_cast<size_t>(top)];
         joint >= 0 && joint != meeting && joint != body_.pelvis;
         joint = skeleton_.parents[static_cast<size_t>(joint)]) {
      between.insert(between.begin(), joint);
    }
    if (between.empty() && meeting != body_.pelvis) between = named(BodyPart::spine);
    // Without a name for the neck, what lies above the arms is one.
    if (body_.neck < 0 && arms_ >= 0) {
      const auto arms = std::find(between.begin(), between.end(), arms_);
      if (arms != between.end() && arms + 1 != between.end()) {
        body_.neck = *(arms + 1);
        between.erase(arms + 1, between.end());
      }
    }
    for (const int joint : between) {
      if (!name(joint).helper && !is_limb(joint) && joint != body_.pelvis && joint != body_.neck &&
          joint != body_.head) {
        body_.spine.push_back(joint);
      }
    }
  }

  const SkeletonView& skeleton_;
  const std::vector<NameReading>& names_;
  Humanoid& body_;
  int legs_ = -1, arms_ = -1;
};

}  // namespace

void find_trunk(const SkeletonView& skeleton, const std::vector<NameReading>& names,
                Humanoid& body) {
  TrunkFinder(skeleton, names, body).find();
}

}  // namespace remomask::rig
