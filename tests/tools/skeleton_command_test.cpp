// The command `skeleton`, and map files.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <functional>

#include "base/file.h"
#include "tests/tools/program_runner.h"

namespace remomask {
namespace {

/// A person as a BVH file of two frames in which each joint is called as `name` says.
std::string person(const std::function<std::string(const std::string&)>& name) {
  std::string text = "HIERARCHY\n";
  const auto open = [&](const std::string& joint, const std::string& offset) {
    text += (text == "HIERARCHY\n" ? "ROOT " : "JOINT ") + name(joint) + "\n{\nOFFSET " + offset +
            "\nCHANNELS " +
            (text.find("CHANNELS") == std::string::npos
                 ? "6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n"
                 : "3 Zrotation Yrotation Xrotation\n");
  };
  const auto close = [&](int joints) {
    for (int i = 0; i < joints; ++i) text += "}\n";
  };
  open("pelvis", "0 95 0");
  for (const int sign : {1, -1}) {
    const std::string side = sign > 0 ? "_l" : "_r";
    open("thigh" + side, fmt::format("{} -4 0", 9 * sign));
    open("calf" + side, "0 -42 0");
    open("foot" + side, "0 -41 -1");
    open("ball" + side, "0 -6 14");
    close(4);
  }
  open("spine_01", "0 12 0");
  open("spine_02", "0 20 0");
  open("neck_01", "0 20 0");
  open("head", "0 10 1");
  close(2);
  for (const int sign : {1, -1}) {
    const std::string side = sign > 0 ? "_l" : "_r";
    open("upperarm" + side, fmt::format("{} 12 0", 18 * sign));
    open("lowerarm" + side, fmt::format("{} 0 0", 27 * sign));
    open("hand" + side, fmt::format("{} 0 0", 25 * sign));
    close(3);
  }
  close(3);
  text += "MOTION\nFrames: 2\nFrame Time: 0.05\n";
  for (int frame = 0; frame < 2; ++frame) {
    text += "0 95 0";
    for (int i = 0; i < 3 * 19; ++i) text += " 0";
    text += "\n";
  }
  return text;
}

TEST(SkeletonCommand, ShowsDrawsAndWritesWhatWasFound) {
  const TestFolder scratch;
  const std::string file = scratch / "walk.bvh", map = scratch / "own.json",
                    picture = scratch / "own.png";
  write_file_atomically(file, person([](const std::string& name) { return name; }));
  const auto found = run_json({"skeleton", file, "--write-map", map, "--picture", picture});
  EXPECT_EQ(found["skeleton_map"], "rules");
  EXPECT_EQ(found["found"]["left_knee"], "calf_l");
  EXPECT_EQ(found["found"]["right_wrist"], "hand_r");
  EXPECT_EQ(found["joints"].size(), 19u);
  EXPECT_EQ(read_file(picture).substr(1, 3), "PNG");
  const ProgramResult table = run_program({"skeleton", file});
  EXPECT_EQ(table.exit_code, 0);
  EXPECT_NE(table.output.find("left_knee       calf_l\n"), std::string::npos) << table.output;

  // The map is read again, under its own name, by all that read motions.
  const auto again = run_json({"skeleton", file, "--skeleton-map", map});
  EXPECT_EQ(again["skeleton_map"], "own");
  EXPECT_EQ(again["found"], found["found"]);
  const auto converted = run_json({"convert", file, scratch / "a.npy", "--skeleton-map", map});
  EXPECT_EQ(converted["skeleton_map"], "own");
  EXPECT_EQ(run_program({"sheet", file, "-o", scratch / "s.png", "--skeleton-map", map}).exit_code,
            0);
}

TEST(SkeletonCommand, AMapFileLeavesOtherSkeletonsAlone) {
  const TestFolder scratch;
  const std::string file = scratch / "walk.bvh", other = scratch / "other.bvh",
                    map = scratch / "own.json";
  write_file_atomically(file, person([](const std::string& name) { return name; }));
  write_file_atomically(other, person([](const std::string& name) { return "x_" + name; }));
  run_json({"skeleton", file, "--write-map", map});
  const auto converted = run_json({"convert", other, scratch / "a.npy", "--skeleton-map", map});
  EXPECT_EQ(converted["skeleton_map"], "rules");
  ASSERT_EQ(converted["warnings"].size(), 1u);
  EXPECT_NE(converted["warnings"][0].get<std::string>().find("fits this skeleton"),
            std::string::npos);
}

TEST(SkeletonCommand, RefusesWithTheNamesOfTheFile) {
  const TestFolder scratch;
  const std::string file = scratch / "camera.bvh";
  write_file_atomically(file,
                        "HIERARCHY\nROOT Camera\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition "
                        "Zposition\nJOINT Lens\n{\nOFFSET 0 0 1\nCHANNELS 0\n}\n}\nMOTION\n"
                        "Frames: 1\nFrame Time: 0.05\n0 0 0\n");
  const ProgramResult result = run_program({"skeleton", file});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.errors.find("Camera, Lens"), std::string::npos) << result.errors;
  EXPECT_NE(result.errors.find("left knee"), std::string::npos) << result.errors;
}

}  // namespace
}  // namespace remomask
