#include "formats/bvh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "remomask/error.h"

namespace remomask {

namespace {

/// Two joints, 9 channels, two frames.
const std::string kSmallBvh =
    "HIERARCHY\n"       // 1
    "ROOT hip\n"        // 2
    "{\n"               // 3
    "  OFFSET 1 2 3\n"  // 4
    "  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "  JOINT knee joint\n"                            // 6
    "  {\n"                                           // 7
    "    OFFSET 0 -5 0\n"                             // 8
    "    CHANNELS 3 Zrotation Xrotation Yrotation\n"  // 9
    "    End Site\n"                                  // 10
    "    {\n"                                         // 11
    "      OFFSET 0 -4 0\n"                           // 12
    "    }\n"                                         // 13
    "  }\n"                                           // 14
    "}\n"                                             // 15
    "MOTION\n"                                        // 16
    "Frames: 2\n"                                     // 17
    "Frame Time: 0.0333333\n"                         // 18
    "10 20 30 0 0 0 0 0 0\n"                          // 19
    "10 20 30 90 0 0 0 90 0\n";                       // 20

std::string with(const std::string& old_text, const std::string& new_text) {
  std::string text = kSmallBvh;
  const size_t at = text.find(old_text);
  EXPECT_NE(at, std::string::npos) << old_text;
  return text.replace(at, old_text.size(), new_text);
}

void expect_point(const float* p, double x, double y, double z) {
  EXPECT_NEAR(p[0], x, 1e-5);
  EXPECT_NEAR(p[1], y, 1e-5);
  EXPECT_NEAR(p[2], z, 1e-5);
}

}  // namespace

TEST(Bvh, ReadsHierarchyAndFrames) {
  const formats::Bvh bvh = formats::parse_bvh(kSmallBvh, "small.bvh");
  ASSERT_EQ(bvh.joints.size(), 2u);
  EXPECT_EQ(bvh.joints[1].name, "knee joint");
  EXPECT_EQ(bvh.joints[1].parent, 0);
  EXPECT_EQ(bvh.joints[1].first_channel, 6);
  EXPECT_EQ(bvh.channels, 9);
  EXPECT_EQ(bvh.frames, 2);
  EXPECT_NEAR(bvh.frame_time, 1 / 30.0, 1e-6);
  EXPECT_EQ(bvh.find_joint("knee joint"), 1);
  EXPECT_EQ(bvh.find_joint("ankle"), -1);
}

TEST(Bvh, ForwardKinematicsByHand) {
  const formats::Bvh bvh = formats::parse_bvh(kSmallBvh, "small.bvh");
  const Vec3 end = *bvh.joints[1].end_site;
  formats::BvhKinematics kinematics(bvh, {{0, Vec3::Zero()}, {1, Vec3::Zero()}, {1, end}});
  float p[9];
  kinematics.positions(0, p);  // positions replace the root's OFFSET
  expect_point(p, 10, 20, 30);
  expect_point(p + 3, 10, 15, 30);
  expect_point(p + 6, 10, 11, 30);
  // 90 degrees about z bring -y to +x; then 90 about the turned x axis (world
  // y) bring the shin from +x to -z.
  kinematics.positions(1, p);
  expect_point(p + 3, 15, 20, 30);
  expect_point(p + 6, 15, 20, 26);
  kinematics.rest_positions(p);
  expect_point(p, 1, 2, 3);
  expect_point(p + 6, 1, -7, 3);
}

TEST(Bvh, ChannelOrderMatters) {
  const formats::Bvh zxy = formats::parse_bvh(with("0 90 0\n", "30 40 50\n"), "a");
  std::string other = with("    CHANNELS 3 Zrotation Xrotation Yrotation",
                           "    CHANNELS 3 Yrotation Xrotation Zrotation");
  other.replace(other.find("0 90 0\n"), 7, "50 40 30\n");
  const formats::Bvh yxz = formats::parse_bvh(other, "b");
  float a[3], b[3];
  formats::BvhKinematics(zxy, {{1, {0, -4, 0}}}).positions(1, a);
  formats::BvhKinematics(yxz, {{1, {0, -4, 0}}}).positions(1, b);
  EXPECT_GT(std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]), 0.5f);
}

TEST(Bvh, ToleratesWhatExportersWrite) {
  std::string windows;
  for (const char c : kSmallBvh) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(formats::parse_bvh("\xEF\xBB\xBF" + windows, "crlf").values,
            formats::parse_bvh(kSmallBvh, "lf").values);
  EXPECT_EQ(formats::parse_bvh(with("ROOT hip\n{", "ROOT hip {"), "brace").joints[0].name, "hip");
  const formats::Bvh numbers =
      formats::parse_bvh(with("10 20 30 0 0 0 0 0 0\n",
                              "  +1e1\t20. .3e2 -0 0.00 -1.5E-3 12345678901234567890e-19 "
                              "0 0.1234567890123456789 \n\n"),
                         "numbers");
  EXPECT_FLOAT_EQ(numbers.values[0], 10);
  EXPECT_FLOAT_EQ(numbers.values[2], 30);
  EXPECT_FLOAT_EQ(numbers.values[5], -0.0015f);
  EXPECT_FLOAT_EQ(numbers.values[6], 1.2345679f);
  EXPECT_FLOAT_EQ(numbers.values[8], 0.12345679f);
  EXPECT_EQ(formats::parse_bvh(kSmallBvh.substr(0, kSmallBvh.size() - 1), "no last newline").frames,
            2);
}

TEST(Bvh, WrittenTextReadsBack) {
  const formats::Bvh bvh = formats::parse_bvh(kSmallBvh, "small.bvh");
  const formats::Bvh again = formats::parse_bvh(formats::format_bvh(bvh), "again");
  EXPECT_EQ(again.values, bvh.values);
  EXPECT_EQ(again.joints[1].name, bvh.joints[1].name);
  EXPECT_EQ(again.joints[1].channels, bvh.joints[1].channels);
  EXPECT_EQ(*again.joints[1].end_site, *bvh.joints[1].end_site);
}

TEST(Bvh, NamesTheLineOfEveryFault) {
  struct Case {
    const char* name;
    std::string text;
    long line;
    const char* message;
  };
  const Case cases[] = {
      {"empty", "", 1, "is empty"},
      {"decimal comma", with("OFFSET 0 -5 0", "OFFSET 0 -5,5 0"), 8, "not a decimal comma"},
      {"decimal comma in a frame", with("10 20 30 90", "10 20,5 30 90"), 20, "decimal comma"},
      {"no time", with("Frame Time: 0.0333333", "Frame Time:"), 18, "Frame Time: nothing"},
      {"other format", "<xml/>", 1, "starts with HIERARCHY"},
      {"no root", "HIERARCHY\n", 2, "truncated"},
      {"root without a name", with("MOTION", "ROOT"), 16, "no name"},
      {"cut in hierarchy", kSmallBvh.substr(0, kSmallBvh.find("End Site")), 10, "truncated"},
      {"no MOTION", kSmallBvh.substr(0, kSmallBvh.find("MOTION")), 16, "no MOTION"},
      {"no frames", kSmallBvh.substr(0, kSmallBvh.find("10 20")), 19, "no frames"},
      {"zero frame time", with("0.0333333", "0"), 18, "--fps"},
      {"nan frame time", with("0.0333333", "nan"), 18, "Frame Time: nan"},
      {"frame rate as frame time", with("0.0333333", "30"), 18, "--fps"},
      {"no frame time", with("Frame Time: 0.0333333\n", ""), 17, "no line \"Frame Time:\""},
      {"nan", with("10 20 30 90", "10 nan 30 90"), 20, "\"nan\", not a finite number"},
      {"inf", with("10 20 30 90", "10 -inf 30 90"), 20, "not a finite number"},
      {"word", with("10 20 30 90", "10 2o 30 90"), 20, "\"2o\""},
      {"overflow", with("10 20 30 90", "10 1e400 30 90"), 20, "too large"},
      {"short frame", with("10 20 30 0 0 0 0 0 0\n", "10 20 30 0 0\n"), 19, "5 values"},
      {"long frame", with("10 20 30 0", "1 10 20 30 0"), 19, "more values"},
      {"cut in frame", kSmallBvh.substr(0, kSmallBvh.size() - 5), 20, "truncated"},
      {"empty name", with("JOINT knee joint", "JOINT"), 6, "no name"},
      {"unknown channel", with("Xposition", "Wposition"), 5, "unknown channel"},
      {"doubled channel", with("Xposition", "Yposition"), 5, "twice"},
      {"absurd channels", with("CHANNELS 6", "CHANNELS 600000"), 5, "0 to 9"},
      {"two CHANNELS lines", with("    End Site", "CHANNELS 1 Xrotation\nEnd Site"), 10, "two"},
      {"no offset", with("    OFFSET 0 -5 0\n", ""), 9, "\"OFFSET\""},
      {"bad offset", with("OFFSET 0 -5 0", "OFFSET 0 x 0"), 8, "needs a number"},
      {"huge offset", with("OFFSET 0 -5 0", "OFFSET 0 1e30 0"), 8, "not a plausible size"},
      {"no channels at all",
       "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n}\nMOTION\nFrames: 1\nFrame Time: 1\n", 6, "channel"},
      {"stray word", with("    End Site", "    Start Site"), 10, "Start"},
      {"binary", with("End Site", std::string("\0\xFF\x01 Site", 8)), 10, "expected"},
  };
  for (const Case& c : cases) {
    try {
      formats::parse_bvh(c.text, "broken.bvh");
      ADD_FAILURE() << c.name << ": was accepted";
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find(c.message), std::string::npos)
          << c.name << ": " << error.what();
      EXPECT_EQ(error.line(), c.line) << c.name << ": " << error.what();
      EXPECT_EQ(error.path(), "broken.bvh");
    }
  }
}

TEST(Bvh, EveryPrefixOfAFileIsRefusedOrEndsWithAFrame) {
  const size_t first_frame_ends = kSmallBvh.find("0 0 0\n10") + 5;
  for (size_t length = 0; length + 3 < kSmallBvh.size(); ++length) {
    const std::string cut = kSmallBvh.substr(0, length);
    if (length == first_frame_ends || length == first_frame_ends + 1) {
      const formats::Bvh bvh = formats::parse_bvh(cut, "cut");
      EXPECT_EQ(bvh.frames, 1);
      EXPECT_EQ(bvh.warnings.size(), 1u);
    } else {
      EXPECT_THROW(formats::parse_bvh(cut, "cut"), FileError) << length;
    }
  }
}

TEST(Bvh, DeepAndWideHierarchiesDoNotExhaustTheStack) {
  std::string text = "HIERARCHY\nROOT j\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
  for (int i = 0; i < 20000; ++i) text += "JOINT j" + std::to_string(i) + "\n{\nOFFSET 0 1 0\n";
  EXPECT_THROW(formats::parse_bvh(text, "deep"), FileError);
}

TEST(Bvh, MissingFileAndFolderAreErrors) {
  EXPECT_THROW(formats::read_bvh("/nowhere/at/all.bvh"), FileError);
  EXPECT_THROW(formats::read_bvh("/"), FileError);
}

}  // namespace remomask
