#include "formats/rest_frame.h"

#include <gtest/gtest.h>

#include "base/file.h"
#include "formats/bvh.h"
#include "formats/bvh_motion.h"
#include "remomask/motion_file.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::make_walker;
using testing_support::temporary_folder;

namespace {

std::string in_scratch(const std::string& name) { return temporary_folder() + "/" + name; }

/// Our walker at 60 frames a second with a frame before it in which the arms are stretched out.
Motion walker_after_rest_pose(int frames, Motion& rest) {
  const Motion walker = make_walker(frames);
  rest = slice(walker, 0, 1);
  for (int side = 0; side < 2; ++side) {
    const double sign = side == 0 ? 1 : -1;
    const Vec3 shoulder = joint_position(rest, 0, 16 + side);
    set_joint_position(rest, 0, 18 + side, shoulder + Vec3(sign * 0.26, 0, 0));
    set_joint_position(rest, 0, 20 + side, shoulder + Vec3(sign * 0.52, 0, 0));
  }
  Motion joined(frames + 1, 22);
  std::copy(rest.positions.begin(), rest.positions.end(), joined.positions.begin());
  std::copy(walker.positions.begin(), walker.positions.end(), joined.positions.begin() + 66);
  return joined;
}

}  // namespace

TEST(RestFrame, IsFoundBeforeAMotion) {
  Motion rest;
  const Motion joined = walker_after_rest_pose(60, rest);
  EXPECT_EQ(formats::count_rest_frames(joined, rest, 60), 1);
  // The performer turned and elsewhere: only the pose counts.
  Motion turned = joined;
  for (int j = 0; j < 22; ++j) {
    const Vec3 p = joint_position(joined, 0, j);
    set_joint_position(turned, 0, j, Vec3(p.z() + 3, p.y(), -p.x()));
  }
  EXPECT_EQ(formats::count_rest_frames(turned, rest, 60), 1);
}

TEST(RestFrame, IsNotSeenWhereThereIsNone) {
  Motion rest;
  const Motion joined = walker_after_rest_pose(60, rest);
  const Motion walker = slice(joined, 1, 61);
  EXPECT_EQ(formats::count_rest_frames(walker, rest, 60), 0);
  // A clip that begins with some frames in the rest pose keeps them: its performer stands so.
  Motion standing(62, 22);
  std::copy(rest.positions.begin(), rest.positions.end(), standing.positions.begin());
  std::copy(joined.positions.begin(), joined.positions.end(), standing.positions.begin() + 66);
  EXPECT_EQ(formats::count_rest_frames(standing, rest, 60), 0);
  EXPECT_EQ(formats::count_rest_frames(rest, rest, 60), 0);
}

TEST(RestFrame, ThatBlendsIntoTheMotionIsLeftOutWithTheBlend) {
  Motion rest;
  const Motion joined = walker_after_rest_pose(60, rest);
  Motion blended(64, 22);  // the rest pose, three frames between, a person who stands
  for (int t = 0; t < 4; ++t) {
    for (int j = 0; j < 22; ++j) {
      const Vec3 from = joint_position(rest, 0, j), to = joint_position(joined, 1, j);
      set_joint_position(blended, t, j, from + (to - from) * (t / 4.));
    }
  }
  for (int t = 4; t < 64; ++t) {
    std::copy(joined.at(1, 0), joined.at(1, 0) + 66, blended.at(t, 0));
  }
  EXPECT_EQ(formats::count_rest_frames(blended, rest, 120), 4);
}

TEST(RestFrame, IsSaidByTheReader) {
  // A BVH file whose first frame has zero rotations.
  save_motion(in_scratch("plain.bvh"), make_walker(60));
  formats::Bvh bvh = formats::parse_bvh(read_file(in_scratch("plain.bvh")), "plain.bvh");
  bvh.joints[0].name = "Reference";  // else it would be a file of our own
  bvh.frames += 1;
  std::vector<float> first(static_cast<size_t>(bvh.channels), 0.f);
  first[1] = bvh.values[1];
  bvh.values.insert(bvh.values.begin(), first.begin(), first.end());
  bvh.frame_time = 1. / 60;
  write_file_atomically(in_scratch("cmu.bvh"), formats::format_bvh(bvh));
  const LoadedMotion loaded = load_motion(in_scratch("cmu.bvh"));
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_NE(loaded.warnings[0].find("rest pose"), std::string::npos) << loaded.warnings[0];
  MotionFileOptions keep;
  keep.skip_frames = 1;  // said by the user: nothing is looked for
  EXPECT_TRUE(load_motion(in_scratch("cmu.bvh"), keep).warnings.empty());
}

}  // namespace remomask
