#include "rig/retarget.h"

#include <gtest/gtest.h>

#include <cmath>

#include "formats/foot_contacts.h"
#include "motion/canonical.h"
#include "motion/rotation.h"
#include "remomask/error.h"
#include "remomask/skeleton.h"
#include "rig/forward_kinematics.h"
#include "rig/joint_names.h"
#include "rig/skeleton_choice.h"
#include "rig/skeleton_view.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::make_walker;

namespace {

struct RigShape {
  double units_per_metre = 1;
  double arms_down = 0, legs_apart = 0;  ///< degrees, of the rest pose
  double arm = 1, leg = 1, shin = 1;     ///< lengths relative to ours
  bool turned_axes = false;              ///< every joint has axes of its own
};

Quat about(const Vec3& axis, double degrees) {
  return Quat(Eigen::AngleAxisd(degrees * M_PI / 180, axis));
}

/// A rig with the names of Mixamo below an armature, made of our own T-pose.
rig::SourceMotion make_rig(const RigShape& shape) {
  const Motion still = motion::canonicalize(make_walker(2), humanml_skeleton());
  const JointRotations own = solve_rotations(still);
  const auto& names = rig::name_preset(JointNames::mixamo).joints;
  std::vector<Vec3> places;
  std::vector<Quat> turns;
  rig::SourceMotion result;
  result.joints.push_back({"Armature", -1, Vec3::Zero(), Quat::Identity(), {}});
  double floor = 0;
  for (size_t j = 0; j < names.size(); ++j) {
    const bool left = names[j].starts_with("Left");
    const double side = left ? 1 : -1;
    Vec3 offset = rig::to_vec(own.rest_offsets[j]) * shape.units_per_metre;
    if (names[j].ends_with("ForeArm") || names[j].ends_with("Hand")) offset *= shape.arm;
    if (names[j].ends_with("Leg") && !names[j].ends_with("UpLeg")) offset *= shape.leg;
    if (names[j].ends_with("Foot")) offset *= shape.leg * shape.shin;
    const int parent = own.parents[j];
    Quat turn = parent < 0 ? Quat::Identity() : turns[static_cast<size_t>(parent)];
    const Vec3 place =
        parent < 0 ? offset : Vec3(places[static_cast<size_t>(parent)] + turn * offset);
    if (names[j] == "LeftArm" || names[j] == "RightArm") {
      turn = about(Vec3::UnitZ(), -side * shape.arms_down);
    }
    if (names[j].ends_with("UpLeg")) turn = about(Vec3::UnitZ(), side * shape.legs_apart);
    if (names[j].ends_with("Foot")) turn = Quat::Identity();  // the foot stays flat
    places.push_back(place);
    turns.push_back(turn);
    floor = std::min(floor, place.y());
  }
  // What a joint's own axes are does not show in the pose.
  std::vector<Quat> axes = {Quat::Identity()};
  for (size_t j = 0; j < names.size(); ++j) {
    axes.push_back(shape.turned_axes ? about(Vec3(1, 2, 3).normalized(), 40.0 * (j + 1))
                                     : Quat::Identity());
    const auto parent = static_cast<size_t>(own.parents[j] + 1);
    const Vec3 above = parent == 0 ? Vec3(0, floor, 0) : places[parent - 1];
    result.joints.push_back({std::string(names[j]),
                             static_cast<int>(parent),
                             axes[parent].conjugate() * (places[j] - above),
                             axes[parent].conjugate() * axes[j + 1],
                             {}});
  }
  return result;
}

Vec3 direction(const std::vector<Vec3>& places, int from, int to) {
  return (places[static_cast<size_t>(to)] - places[static_cast<size_t>(from)]).normalized();
}

double degrees_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI;
}

struct Fit {
  double worst_direction = 0;  ///< degrees, of arms and legs
  double worst_ankle = 0;      ///< metres, of its height over the floor
  double worst_slide = 0;      ///< metres a frame that a standing toe moves unlike the source's
};

Fit fit_of(const Motion& motion, const RigShape& shape) {
  const JointRotations own = solve_rotations(motion);
  const Motion placed = rig::joint_positions(own);
  const rig::SourceMotion character = make_rig(shape);
  const rig::SkeletonView view = rig::view_of(character);
  const rig::BodyJoints body =
      rig::body_joints(rig::choose_skeleton_map(view, "", "rig").map, view);
  const kinematics::FootContacts contacts = formats::foot_contacts(placed);
  const rig::SourceMotion moved = rig::retarget(own, character, body, contacts);
  EXPECT_EQ(moved.frames, motion.frames);
  const std::vector<Vec3> rest = rig::world_positions(character, -1);
  const double own_leg = (joint_position(placed, 0, 1) - joint_position(placed, 0, 4)).norm() +
                         (joint_position(placed, 0, 4) - joint_position(placed, 0, 7)).norm();
  const double leg =
      (rest[body[1]] - rest[body[4]]).norm() + (rest[body[4]] - rest[body[7]]).norm();
  double own_ankle = 0;
  for (int j = 7; j >= 0; j = own.parents[j]) own_ankle += own.rest_offsets[j][1];
  Fit fit;
  std::vector<Vec3> before;
  for (int t = 0; t < moved.frames; ++t) {
    const std::vector<Vec3> places = rig::world_positions(moved, t);
    std::vector<Vec3> ours;
    for (int j = 0; j < 22; ++j) ours.push_back(joint_position(placed, t, j));
    for (const auto& [from, to] :
         {std::pair{16, 18}, {18, 20}, {17, 19}, {19, 21}, {1, 4}, {4, 7}, {2, 5}, {5, 8}}) {
      fit.worst_direction = std::max(
          fit.worst_direction,
          degrees_between(direction(places, body[from], body[to]), direction(ours, from, to)));
    }
    for (const int ankle : {7, 8}) {
      const double expected = rest[body[ankle]].y() + (ours[ankle].y() - own_ankle) * leg / own_leg;
      fit.worst_ankle = std::max(
          fit.worst_ankle, std::abs(places[body[ankle]].y() - expected) / shape.units_per_metre);
    }
    for (const size_t side : {0, 1}) {
      if (t == 0 || !contacts[t][side] || !contacts[t - 1][side]) continue;
      const Vec3 own_slide = ours[10 + side] - joint_position(placed, t - 1, 10 + side);
      Vec3 slide = places[body[10 + side]] - before[body[10 + side]] - leg / own_leg * own_slide;
      slide.y() = 0;
      fit.worst_slide = std::max(fit.worst_slide, slide.norm() / shape.units_per_metre);
    }
    before = places;
  }
  return fit;
}

Motion walk() {
  return motion::canonicalize(make_walker(60, [](int t) { return 0.02 * t; }), humanml_skeleton());
}

}  // namespace

TEST(Retarget, LimbsPointWhereTheyDidOnATPoseRigOfOtherProportions) {
  const Fit fit = fit_of(walk(), {.units_per_metre = 100, .arm = 1.15, .leg = 0.9});
  EXPECT_LT(fit.worst_direction, 2);
  EXPECT_LT(fit.worst_ankle, 0.01);
  EXPECT_LT(fit.worst_slide, 0.002);
}

TEST(Retarget, LimbsPointWhereTheyDidOnAnAPoseRig) {
  const Fit fit = fit_of(walk(), {.arms_down = 45,
                                  .legs_apart = 8,
                                  .arm = 0.85,
                                  .leg = 1.1,
                                  .shin = 1.03,
                                  .turned_axes = true});
  EXPECT_LT(fit.worst_direction, 2);
  EXPECT_LT(fit.worst_ankle, 0.01);
  EXPECT_LT(fit.worst_slide, 0.002);
}

TEST(Retarget, ARigWithoutKneesIsRefusedByName) {
  rig::SourceMotion character = make_rig({});
  const rig::SkeletonView view = rig::view_of(character);
  rig::SkeletonMap map = rig::choose_skeleton_map(view, "", "rig").map;
  map.points[4].to = map.points[7].from;
  map.points[4].weight = 0.5;
  try {
    rig::body_joints(map, view);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("left_knee"), std::string::npos) << error.what();
  }
}

}  // namespace remomask
