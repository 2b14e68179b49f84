#include "remomask/skeleton.h"

#include "base/time.h"
#include "remomask/error.h"

namespace remomask {

namespace {

using Direction = std::array<double, 3>;

constexpr Direction kNone{0, 0, 0}, kUp{0, 1, 0}, kDown{0, -1, 0}, kLeft{1, 0, 0}, kRight{-1, 0, 0},
    kFront{0, 0, 1};

Skeleton make_humanml_skeleton() {
  Skeleton s;
  s.name = "humanml3d";
  s.joint_names = {"pelvis",     "left_hip",      "right_hip",      "spine1",      "left_knee",
                   "right_knee", "spine2",        "left_ankle",     "right_ankle", "spine3",
                   "left_foot",  "right_foot",    "neck",           "left_collar", "right_collar",
                   "head",       "left_shoulder", "right_shoulder", "left_elbow",  "right_elbow",
                   "left_wrist", "right_wrist"};
  s.parents = {-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19};
  s.chains = {{0, 2, 5, 8, 11},
              {0, 1, 4, 7, 10},
              {0, 3, 6, 9, 12, 15},
              {9, 14, 17, 19, 21},
              {9, 13, 16, 18, 20}};
  s.rest_directions = {kNone, kLeft, kRight, kUp,    kDown, kDown, kUp,    kDown,
                       kDown, kUp,   kFront, kFront, kUp,   kLeft, kRight, kFront,
                       kDown, kDown, kDown,  kDown,  kDown, kDown};
  // Bone lengths of HumanML3D's clip 000021, which every clip is scaled to.
  s.bone_lengths = {0,        0.103074, 0.109883, 0.131568, 0.393623, 0.390188, 0.143190, 0.432433,
                    0.425643, 0.057365, 0.143382, 0.149419, 0.219360, 0.137487, 0.143383, 0.103039,
                    0.131614, 0.122984, 0.256840, 0.263092, 0.266012, 0.269876};
  s.mirror = {0, 2, 1, 3, 5, 4, 6, 8, 7, 9, 11, 10, 12, 14, 13, 15, 17, 16, 19, 18, 21, 20};
  s.right_hip = 2;
  s.left_hip = 1;
  s.right_shoulder = 17;
  s.left_shoulder = 16;
  s.leg_upper = 5;
  s.leg_lower = 8;
  s.left_feet = {7, 10};
  s.right_feet = {8, 11};
  s.contact_threshold = 0.002;
  s.fps = kFps;
  return s;
}

Skeleton make_kit_skeleton() {
  Skeleton s;
  s.name = "kit";
  s.joint_names = {"pelvis",         "spine1",      "spine2",      "neck",          "head",
                   "right_shoulder", "right_elbow", "right_wrist", "left_shoulder", "left_elbow",
                   "left_wrist",     "right_hip",   "right_knee",  "right_ankle",   "right_foot",
                   "right_toe",      "left_hip",    "left_knee",   "left_ankle",    "left_foot",
                   "left_toe"};
  s.parents = {-1, 0, 1, 2, 3, 3, 5, 6, 3, 8, 9, 0, 11, 12, 13, 14, 0, 16, 17, 18, 19};
  s.chains = {{0, 11, 12, 13, 14, 15},
              {0, 16, 17, 18, 19, 20},
              {0, 1, 2, 3, 4},
              {3, 5, 6, 7},
              {3, 8, 9, 10}};
  // The right side rests at +X as in the official table, although it lies at -X in the data.
  s.rest_directions = {kNone,  kUp,    kUp,    kUp,   kUp,   kLeft,  kDown,
                       kDown,  kRight, kDown,  kDown, kLeft, kDown,  kDown,
                       kFront, kFront, kRight, kDown, kDown, kFront, kFront};
  s.bone_lengths.assign(21, 0.0);
  s.mirror = {0, 1, 2, 3, 4, 8, 9, 10, 5, 6, 7, 16, 17, 18, 19, 20, 11, 12, 13, 14, 15};
  s.right_hip = 11;
  s.left_hip = 16;
  s.right_shoulder = 5;
  s.left_shoulder = 8;
  s.leg_upper = 17;
  s.leg_lower = 18;
  s.left_feet = {19, 20};
  s.right_feet = {14, 15};
  s.contact_threshold = 0.05;
  s.fps = 12.5;
  return s;
}

}  // namespace

const Skeleton& humanml_skeleton() {
  static const Skeleton skeleton = make_humanml_skeleton();
  return skeleton;
}

const Skeleton& kit_skeleton() {
  static const Skeleton skeleton = make_kit_skeleton();
  return skeleton;
}

const Skeleton& skeleton_named(const std::string& name) {
  if (name == "humanml3d") return humanml_skeleton();
  if (name == "kit") return kit_skeleton();
  throw Error("unknown skeleton \"" + name + "\"; use humanml3d or kit");
}

}  // namespace remomask
