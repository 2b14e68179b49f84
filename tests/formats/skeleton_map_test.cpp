#include "formats/skeleton_map.h"

#include <gtest/gtest.h>

#include <set>

#include "formats/inverse_kinematics.h"
#include "remomask/error.h"
#include "tests/motion/support.h"

namespace remomask {

namespace {

/// A skeleton that has exactly the joints that a map names, each with an End Site.
formats::Bvh skeleton_of(const formats::SkeletonMap& map, const std::string& prefix = "") {
  std::set<std::string> names(map.identify.begin(), map.identify.end());
  for (const formats::MappedPoint& point : map.points) {
    names.insert(point.from);
    if (!point.to.empty()) names.insert(point.to);
  }
  formats::Bvh bvh;
  for (const std::string& name : names) {
    formats::BvhJoint joint;
    joint.name = prefix + name;
    joint.parent = bvh.joints.empty() ? -1 : 0;
    joint.end_site = Vec3(0, 1, 0);
    bvh.joints.push_back(joint);
  }
  return bvh;
}

}  // namespace

TEST(SkeletonMap, ShipsFifteenAndFindsEachByItsOwnJoints) {
  const std::vector<formats::SkeletonMap>& maps = formats::shipped_skeleton_maps();
  EXPECT_EQ(maps.size(), 15u);
  for (const formats::SkeletonMap& map : maps) {
    EXPECT_EQ(formats::find_skeleton_map(maps, skeleton_of(map), "x.bvh").name, map.name);
  }
}

TEST(SkeletonMap, OverlooksNamespaces) {
  const std::vector<formats::SkeletonMap>& maps = formats::shipped_skeleton_maps();
  for (const formats::SkeletonMap& map : maps) {
    if (map.name != "cmu_neo") continue;
    const formats::Bvh bvh = skeleton_of(map, "mixamorig:");
    EXPECT_EQ(formats::find_skeleton_map(maps, bvh, "x.bvh").name, "cmu_neo");
    formats::MappedKinematics kinematics(bvh, map);  // finds them by the short names, too
    float out[66];
    kinematics.rest_positions(out);
    EXPECT_EQ(out[0], 0.f);
  }
}

TEST(SkeletonMap, SaysWhatIsMissing) {
  formats::Bvh bvh = formats::motion_to_bvh(testing_support::make_walker(2));
  for (formats::BvhJoint& joint : bvh.joints) {
    if (joint.name == "LeftToe") joint.name = "LeftPaw";
  }
  try {
    formats::find_skeleton_map(formats::shipped_skeleton_maps(), bvh, "cat.bvh");
    ADD_FAILURE() << "was accepted";
  } catch (const FileError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("cat.bvh"), std::string::npos) << text;
    EXPECT_NE(text.find("\"remomask\", misses LeftToe"), std::string::npos) << text;
    EXPECT_NE(text.find("map file"), std::string::npos) << text;
  }
}

TEST(SkeletonMap, PointsAreBlendsEndSitesAndFixedPoints) {
  formats::Bvh bvh = skeleton_of(formats::shipped_skeleton_maps()[0]);
  for (formats::BvhJoint& joint : bvh.joints) joint.offset = Vec3(2, 0, 0);
  bvh.joints[0].offset = Vec3::Zero();
  formats::SkeletonMap map = formats::shipped_skeleton_maps()[0];
  const std::string root = bvh.joints[0].name, other = bvh.joints[1].name;
  map.points[0] = {root, other, false, std::nullopt, 0.25};
  map.points[1] = {other, "", true, std::nullopt, 0.5};
  map.points[2] = {other, "", false, Vec3(0, 0, 7), 1};
  float p[66];
  formats::MappedKinematics(bvh, map).rest_positions(p);
  EXPECT_FLOAT_EQ(p[0], 0.5f);
  EXPECT_FLOAT_EQ(p[3], 2.f);
  EXPECT_FLOAT_EQ(p[4], 0.5f);
  EXPECT_FLOAT_EQ(p[8], 7.f);
}

TEST(SkeletonMap, RefusesBrokenMapFiles) {
  for (const char* text : {"", "[1, 2]", "{}", "{\"skeletons\": {}}", "{\"pelvis\": \"Hips\"}",
                           "{\"skeletons\": {\"a\": {\"pelvis\": 3}}}"}) {
    EXPECT_THROW(formats::parse_skeleton_maps(text, "map.json"), FileError) << text;
  }
}

}  // namespace remomask
