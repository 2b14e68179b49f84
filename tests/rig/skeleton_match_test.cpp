#include "rig/skeleton_match.h"

#include <gtest/gtest.h>

#include "remomask/error.h"
#include "rig/mapped_source.h"
#include "rig/name_reading.h"
#include "rig/skeleton_choice.h"
#include "tests/rig/known_rigs.h"

namespace remomask {

using testing_support::build_rig;
using testing_support::BuiltRig;
using testing_support::known_rigs;
using testing_support::RigNames;
using testing_support::RigOptions;

namespace {

int joint_of_ours(const std::string& name) {
  const std::vector<std::string>& names = humanml_skeleton().joint_names;
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// Matches a rig and compares our joints in its frame with where they are.
void expect_recognised(const RigNames& names, const RigOptions& options) {
  SCOPED_TRACE(names.program + (options.scrambled_rest ? ", scrambled rest pose" : "") +
               (options.zero_offsets ? ", no offsets" : "") +
               (options.reversed ? ", reversed" : ""));
  const BuiltRig built = build_rig(names, options);
  const rig::SkeletonMatch match = rig::match_skeleton(view_of(built.motion));
  ASSERT_TRUE(match.map) << match.objection << testing::PrintToString(match.missing);
  EXPECT_TRUE(match.by_names);
  Motion pose(1, 22);
  rig::MappedSource(built.motion, *match.map).positions(0, pose.at(0, 0));
  for (const auto& [name, truth] : built.truth) {
    const double tolerance = name == "neck" ? 5 : 0.05;  // cm; deep necks are ours higher up
    EXPECT_LT((joint_position(pose, 0, joint_of_ours(name)) - truth).norm(), tolerance) << name;
  }
  // The trunk rises through the heights of the SMPL body, whatever joints there are.
  const double heights[] = {97, 109, 120, 128};
  const char* trunk[] = {"pelvis", "spine1", "spine2", "spine3"};
  for (int i = 0; i < 4; ++i) {
    const Vec3 point = joint_position(pose, 0, joint_of_ours(trunk[i]));
    EXPECT_NEAR(point.y(), heights[i], 5) << trunk[i];
    EXPECT_NEAR(point.x(), 0, 0.1) << trunk[i];
  }
  for (int side = 0; side < 2; ++side) {
    const double sign = side == 0 ? 1 : -1;
    const Vec3 toe = joint_position(pose, 0, 10 + side), wrist = joint_position(pose, 0, 20 + side),
               collar = joint_position(pose, 0, 13 + side);
    if (!options.scrambled_rest) {
      EXPECT_GT(toe.z(), 5) << side;  // before the ankle, also where there is no joint for it
      EXPECT_GT(wrist.x() * sign, 60) << side;
    }
    EXPECT_GT(collar.x() * sign, 2) << side;
    EXPECT_LT(collar.x() * sign, 12) << side;
  }
}

}  // namespace

TEST(SkeletonMatch, RecognisesEveryKnownRigInItsTPose) {
  for (const RigNames& names : known_rigs()) expect_recognised(names, {});
}

TEST(SkeletonMatch, DoesNotNeedRestPosesThatStand) {
  for (const RigNames& names : known_rigs()) {
    RigOptions options;
    options.scrambled_rest = true;
    expect_recognised(names, options);
  }
}

TEST(SkeletonMatch, DoesNotNeedOffsetsOrAnOrder) {
  for (const RigNames& names : known_rigs()) {
    RigOptions options;
    options.zero_offsets = true;
    options.reversed = true;
    expect_recognised(names, options);
  }
}

TEST(SkeletonMatch, TakesFlatListsOfBones) {
  for (RigNames names : known_rigs()) {
    if (names.program != "Rigify, deforming bones" && names.program != "Unreal" &&
        names.program != "SMPL") {
      continue;
    }
    SCOPED_TRACE(names.program);
    names.roots = {"Armature"};
    names.others.clear();
    BuiltRig built = build_rig(names);
    const std::vector<Vec3> world = world_positions(built.motion, -1);
    for (size_t j = 1; j < world.size(); ++j) {
      built.motion.joints[j].parent = 0;
      built.motion.joints[j].offset = world[j];
      for (int axis = 0; axis < 3; ++axis) {
        built.motion.translations[j * 3 + static_cast<size_t>(axis)] =
            static_cast<float>(world[j][axis]);
      }
    }
    const rig::SkeletonMatch match = rig::match_skeleton(view_of(built.motion));
    ASSERT_TRUE(match.map) << match.objection << testing::PrintToString(match.missing);
    Motion pose(1, 22);
    rig::MappedSource(built.motion, *match.map).positions(0, pose.at(0, 0));
    for (const auto& [name, truth] : built.truth) {
      EXPECT_LT((joint_position(pose, 0, joint_of_ours(name)) - truth).norm(), 5) << name;
    }
    EXPECT_NEAR(joint_position(pose, 0, 0).y(), 97, 5);
  }
}

TEST(SkeletonMatch, ReadsNames) {
  const auto words = [](const char* name) { return rig::words_of_name(name); };
  using Words = std::vector<std::string>;
  EXPECT_EQ(words("mixamorig:LeftUpLeg"), (Words{"left", "up", "leg"}));
  EXPECT_EQ(words("lfemur"), (Words{"l", "femur"}));
  EXPECT_EQ(words("LThigh"), (Words{"l", "thigh"}));
  EXPECT_EQ(words("LHipJoint"), (Words{"l", "hip", "joint"}));
  EXPECT_EQ(words("upperarm_l"), (Words{"upperarm", "l"}));
  EXPECT_EQ(words("Bip01 L Thigh"), (Words{"bip", "01", "l", "thigh"}));
  EXPECT_EQ(words("DEF-spine.001"), (Words{"def", "spine", "001"}));
  EXPECT_EQ(words("rHand"), (Words{"r", "hand"}));
  EXPECT_EQ(words("LUArm"), (Words{"left", "upper", "arm"}));
  EXPECT_EQ(words("左足首"), (Words{"left", "ankle"}));
  EXPECT_EQ(words("leftupleg"), (Words{"left", "upleg"}));
}

TEST(SkeletonMatch, FindsABodyByItsShapeWhereNamesSayNothing) {
  RigNames names = known_rigs()[0];
  names.others.clear();
  BuiltRig built = build_rig(names);
  for (size_t j = 0; j < built.motion.joints.size(); ++j) {
    built.motion.joints[j].name = "Bone." + std::to_string(j);
  }
  const rig::SkeletonMatch match = rig::match_skeleton(view_of(built.motion));
  ASSERT_TRUE(match.map) << match.objection << testing::PrintToString(match.missing);
  EXPECT_FALSE(match.by_names);
  Motion pose(1, 22);
  rig::MappedSource(built.motion, *match.map).positions(0, pose.at(0, 0));
  for (const auto& [name, truth] : built.truth) {
    EXPECT_LT((joint_position(pose, 0, joint_of_ours(name)) - truth).norm(), 0.05) << name;
  }
  const rig::ChosenSkeletonMap chosen =
      rig::choose_skeleton_map(view_of(built.motion), "", "bones.glb");
  ASSERT_EQ(chosen.warnings.size(), 1u);
  EXPECT_NE(chosen.warnings[0].find("by its shape"), std::string::npos);
}

TEST(SkeletonMatch, RefusesWhatIsNoHumanAndNamesItsJoints) {
  // A dog: the names are those of a person, the build is not.
  RigNames names = known_rigs()[0];
  names.others = {"Tail<mixamorig:Hips", "Tail1<Tail"};
  BuiltRig dog = build_rig(names);
  for (rig::SourceJoint& joint : dog.motion.joints) {
    if (joint.name.find("Leg") != std::string::npos) joint.offset *= 0.4;
    if (joint.name.find("Foot") != std::string::npos) joint.offset *= 0.4;
    if (joint.name.find("Spine") != std::string::npos) {
      joint.offset = Vec3(0, 0, joint.offset.norm() * 1.5);
    }
  }
  dog.motion.frames = 0;
  EXPECT_FALSE(rig::match_skeleton(view_of(dog.motion)).objection.empty());
  rig::SourceMotion camera;
  for (const char* name : {"Scene", "Camera", "Camera_Target", "Light"}) {
    rig::SourceJoint joint;
    joint.name = name;
    joint.parent = camera.joints.empty() ? -1 : 0;
    camera.joints.push_back(joint);
  }
  try {
    rig::choose_skeleton_map(view_of(camera), "", "shot.glb");
    ADD_FAILURE() << "was accepted";
  } catch (const FileError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("shot.glb"), std::string::npos) << text;
    EXPECT_NE(text.find("left knee"), std::string::npos) << text;
    EXPECT_NE(text.find("Scene, Camera, Camera_Target, Light"), std::string::npos) << text;
    EXPECT_NE(text.find("--skeleton-map"), std::string::npos) << text;
  }
}

TEST(SkeletonMatch, MapsOfAFileOverrideOnlyWhatTheyFit) {
  const BuiltRig built = build_rig(known_rigs()[7]);
  const rig::SkeletonView view = view_of(built.motion);
  const rig::SkeletonMap by_rules = rig::choose_skeleton_map(view, "", "a.bvh").map;
  EXPECT_EQ(by_rules.name, "rules");
  EXPECT_THROW(rig::choose_skeleton_map(view, "bandai", "a.bvh"), FileError);
  EXPECT_THROW(rig::choose_skeleton_map(view, "no such map", "a.bvh"), Error);
}

}  // namespace remomask
