#include "formats/acclaim.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>

#include "base/file.h"
#include "formats/asf_skeleton.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::temporary_folder;

namespace {

const std::string kAsf =
    "# a comment\n"
    ":version 1.10\n"
    ":name SMALL\n"
    ":units\n"
    "  mass 1.0\n"
    "  length 0.45\n"
    "  angle deg\n"
    ":documentation\n"
    "   of no interest\n"
    ":root\n"
    "   order TX TY TZ RX RY RZ\n"
    "   axis XYZ\n"
    "   position 0 0 0\n"
    "   orientation 0 0 0\n"
    ":bonedata\n"
    "  begin\n"
    "     id 1\n"
    "     name thigh\n"
    "     direction 0 -1 0\n"
    "     length 7\n"
    "     axis 0 0 90  XYZ\n"
    "    dof rx ry rz\n"
    "    limits (-160.0 20.0)\n"
    "           (-70.0 70.0)\n"
    "           (-60.0 70.0)\n"
    "  end\n"
    "  begin\n"
    "     id 2\n"
    "     name shin\n"
    "     direction 0 -2 0\n"
    "     length 6\n"
    "     axis 0 0 0  XYZ\n"
    "    dof rx\n"
    "  end\n"
    ":hierarchy\n"
    "  begin\n"
    "    root thigh\n"
    "    thigh shin\n"
    "  end\n";

const std::string kAmc =
    "#!OML:ASF somewhere\n"
    ":FULLY-SPECIFIED\n"
    ":DEGREES\n"
    "1\n"
    "root 1 2 3 0 0 0\n"
    "thigh 0 0 0\n"
    "shin 0\n"
    "2\n"
    "root 1 2 3 0 90 0\n"
    "thigh 90 0 0\n"
    "shin 8.82107e-015\n";

formats::AcclaimMotion parse(const std::string& asf, const std::string& amc) {
  return formats::parse_acclaim(asf, "s.asf", amc, "m.amc");
}

std::string refusal(const std::string& asf, const std::string& amc) {
  try {
    parse(asf, amc);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

std::string text_with(std::string text, const std::string& from, const std::string& to) {
  EXPECT_NE(text.find(from), std::string::npos) << from;
  return text.replace(text.find(from), from.size(), to);
}

void expect_at(const Vec3& point, double x, double y, double z) {
  EXPECT_LT((point - Vec3(x, y, z)).norm(), 1e-5) << point.transpose();
}

}  // namespace

TEST(Acclaim, JointsByHand) {
  const formats::AcclaimMotion read = parse(kAsf, kAmc);
  const rig::SourceMotion& source = read.source;
  ASSERT_EQ(source.joints.size(), 3u);
  EXPECT_EQ(source.joints[1].name, "thigh");
  EXPECT_EQ(source.joints[2].parent, 1);
  EXPECT_EQ(source.frames, 2);
  EXPECT_EQ(source.fps, 0);
  EXPECT_NEAR(*source.metres_per_unit, 0.056444, 1e-6);
  EXPECT_EQ(*source.joints[2].end_site, Vec3(0, -6, 0));
  EXPECT_TRUE(read.warnings.empty());
  const auto first = rig::world_positions(source, 0);
  expect_at(first[0], 1, 2, 3);
  expect_at(first[1], 1, 2, 3);  // the thigh begins where the root ends
  expect_at(first[2], 1, -5, 3);
  // 90 degrees about the bone's X, which its axes turn to the body's Y: the thigh turns about
  // itself; the root turns about Y.
  const auto second = rig::world_positions(source, 1);
  expect_at(second[2], 1, -5, 3);
}

TEST(Acclaim, AnglesTurnAboutTheAxesOfTheBone) {
  // Z of the bone is Z of the body: a quarter turn brings -Y to +X.
  const auto joints =
      rig::world_positions(parse(kAsf, text_with(kAmc, "thigh 0 0 0", "thigh 0 0 90")).source, 0);
  expect_at(joints[2], 8, 2, 3);
  // Y of the bone is -X of the body.
  const auto other =
      rig::world_positions(parse(kAsf, text_with(kAmc, "thigh 0 0 0", "thigh 0 90 0")).source, 0);
  expect_at(other[2], 1, 2, 10);
}

TEST(Acclaim, RadiansRatesAndLineEnds) {
  std::string amc = text_with(kAmc, ":DEGREES", ":RADIANS\n:SAMPLES-PER-SECOND 60");
  amc = text_with(amc, "thigh 0 0 0", "thigh 0 0 1.5707963267948966");
  std::string windows;
  for (const char c : amc) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  const formats::AcclaimMotion read = parse("\xEF\xBB\xBF" + kAsf, windows);
  EXPECT_EQ(read.source.fps, 60);
  EXPECT_TRUE(read.warnings.empty());
  expect_at(rig::world_positions(read.source, 0)[2], 8, 2, 3);
}

TEST(Acclaim, FaultsAreNamedWithTheirLine) {
  const std::pair<std::string, const char*> cases[] = {
      {refusal(kAsf, ""), "no frames"},
      {refusal(kAsf, "thigh 1 2 3\n"), "m.amc:1: expected the number of a frame"},
      {refusal(kAsf, text_with(kAmc, "shin 0\n", "")),
       "m.amc:7: the frame before this line has no"},
      {refusal(kAsf, kAmc.substr(0, kAmc.find("shin 8"))), "no values of \"shin\""},
      {refusal(kAsf, text_with(kAmc, "shin 0", "shin 0 0")), "m.amc:7: \"shin\" has 2 values"},
      {refusal(kAsf, text_with(kAmc, "shin 0", "shin nan")), "m.amc:7: shin needs a finite number"},
      {refusal(kAsf, text_with(kAmc, "shin 0", "tail 0")),
       "m.amc:7: the skeleton has no bone \"tail\""},
      {refusal(kAsf, text_with(kAmc, "shin 0", "thigh 0 0 0")),
       "m.amc:7: \"thigh\" is there twice"},
      {refusal("", kAmc), "no bones"},
      {refusal(text_with(kAsf, "dof rx\n", "dof wx\n"), kAmc),
       "s.asf:33: unknown degree of freedom"},
      {refusal(text_with(kAsf, "    thigh shin\n", ""), kAmc), "\"shin\" hangs on no other"},
      {refusal(text_with(kAsf, "thigh shin", "thigh fin"), kAmc),
       "s.asf:38: there is no bone \"fin\""},
      {refusal(text_with(kAsf, "root thigh\n", "shin thigh\n"), kAmc), "hangs on no other"},
      {refusal(text_with(kAsf, "name shin", "name thigh"), kAmc), "two bones are named"},
      {refusal(text_with(kAsf, "XYZ\n    dof rx ry", "XQZ\n    dof rx ry"), kAmc), "order of axes"},
      {refusal(kAsf.substr(0, kAsf.find("name shin")), kAmc), "truncated"},
  };
  for (const auto& [text, part] : cases) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

TEST(Acclaim, FindsTheSkeletonBesideTheMotion) {
  namespace fs = std::filesystem;
  const std::string folder = temporary_folder() + "/acclaim";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const auto path = [&](const std::string& name) { return folder + "/" + name; };
  const auto find = [&] {
    return fs::path(formats::find_asf(path("07_02.amc"))).filename().string();
  };
  try {
    formats::find_asf(path("07_02.amc"));
    ADD_FAILURE() << "was found";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("07_02.asf"), std::string::npos);
  }
  write_file_atomically(path("any.asf"), kAsf);
  EXPECT_EQ(find(), "any.asf");  // the only one
  write_file_atomically(path("08.asf"), kAsf);
  EXPECT_THROW(find(), FileError);
  write_file_atomically(path("07.ASF"), kAsf);
  EXPECT_EQ(find(), "07.ASF");  // of the subject
  write_file_atomically(path("07_02.asf"), kAsf);
  EXPECT_EQ(find(), "07_02.asf");  // of the same name
}

}  // namespace remomask
