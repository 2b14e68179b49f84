#include "rig/skeleton_map.h"

#include <gtest/gtest.h>

#include <set>

#include "remomask/error.h"
#include "rig/mapped_source.h"

namespace remomask {

namespace {

/// A skeleton that has exactly the joints that a map names, each with an End Site.
rig::SourceMotion skeleton_of(const rig::SkeletonMap& map, const std::string& prefix = "") {
  std::set<std::string> names(map.identify.begin(), map.identify.end());
  for (const rig::MappedPoint& point : map.points) {
    names.insert(point.from);
    if (!point.to.empty()) names.insert(point.to);
  }
  rig::SourceMotion source;
  for (const std::string& name : names) {
    rig::SourceJoint joint;
    joint.name = prefix + name;
    joint.parent = source.joints.empty() ? -1 : 0;
    joint.end_site = Vec3(0, 1, 0);
    source.joints.push_back(joint);
  }
  return source;
}

}  // namespace

TEST(SkeletonMap, ShipsFifteenAndFindsEachByItsOwnJoints) {
  const std::vector<rig::SkeletonMap>& maps = rig::shipped_skeleton_maps();
  EXPECT_EQ(maps.size(), 15u);
  for (const rig::SkeletonMap& map : maps) {
    const rig::SkeletonMap* found = rig::fitting_skeleton_map(maps, view_of(skeleton_of(map)));
    ASSERT_TRUE(found) << map.name;
    EXPECT_EQ(found->name, map.name);
  }
}

TEST(SkeletonMap, OverlooksNamespaces) {
  const std::vector<rig::SkeletonMap>& maps = rig::shipped_skeleton_maps();
  for (const rig::SkeletonMap& map : maps) {
    if (map.name != "cmu_neo") continue;
    const rig::SourceMotion source = skeleton_of(map, "mixamorig:");
    EXPECT_EQ(rig::fitting_skeleton_map(maps, view_of(source))->name, "cmu_neo");
    rig::MappedSource kinematics(source, map);  // finds them by the short names, too
    float out[66];
    kinematics.positions(-1, out);
    EXPECT_EQ(out[0], 0.f);
  }
}

TEST(SkeletonMap, SaysWhatIsMissing) {
  const rig::SkeletonMap& map = rig::shipped_skeleton_maps()[0];
  rig::SkeletonView view = view_of(skeleton_of(map));
  const std::string lost = view.names[3];
  view.names[3] = "Paw";
  EXPECT_FALSE(rig::fitting_skeleton_map({map}, view));
  EXPECT_EQ(rig::missing_joints(map, view).front(), lost);
  EXPECT_THROW(rig::place_points(map, view), Error);
}

TEST(SkeletonMap, PointsAreBlendsEndSitesAndFixedPoints) {
  rig::SourceMotion source = skeleton_of(rig::shipped_skeleton_maps()[0]);
  for (rig::SourceJoint& joint : source.joints) joint.offset = Vec3(2, 0, 0);
  source.joints[0].offset = Vec3::Zero();
  rig::SkeletonMap map = rig::shipped_skeleton_maps()[0];
  const std::string root = source.joints[0].name, other = source.joints[1].name;
  map.points[0] = {root, other, false, std::nullopt, 0.25};
  map.points[1] = {other, "", true, std::nullopt, 0.5};
  map.points[2] = {other, "", false, Vec3(0, 0, 7), 1};
  float p[66];
  rig::MappedSource(source, map).positions(-1, p);
  EXPECT_FLOAT_EQ(p[0], 0.5f);
  EXPECT_FLOAT_EQ(p[3], 2.f);
  EXPECT_FLOAT_EQ(p[4], 0.5f);
  EXPECT_FLOAT_EQ(p[8], 7.f);
}

TEST(SkeletonMap, WritesWhatItReads) {
  const std::vector<rig::SkeletonMap>& maps = rig::shipped_skeleton_maps();
  const std::string text = rig::format_skeleton_maps(maps);
  const std::vector<rig::SkeletonMap> back = rig::parse_skeleton_maps(text, "maps.json");
  ASSERT_EQ(back.size(), maps.size());
  EXPECT_EQ(rig::format_skeleton_maps(back).size(), text.size());
  for (const rig::SkeletonMap& map : back) {
    EXPECT_EQ(rig::fitting_skeleton_map(maps, view_of(skeleton_of(map)))->name, map.name);
  }
}

TEST(SkeletonMap, RefusesBrokenMapFiles) {
  for (const char* text : {"", "[1, 2]", "{}", "{\"skeletons\": {}}", "{\"pelvis\": \"Hips\"}",
                           "{\"skeletons\": {\"a\": {\"pelvis\": 3}}}"}) {
    EXPECT_THROW(rig::parse_skeleton_maps(text, "map.json"), FileError) << text;
  }
}

}  // namespace remomask
