// What other programs write and Blender reads: read with the same result as the plain file.
#include <gtest/gtest.h>

#include "formats/bvh.h"
#include "remomask/error.h"

namespace remomask {

namespace {

/// Three joints, 12 channels, three frames.
const std::string kPlain =
    "HIERARCHY\n"
    "ROOT hip\n"
    "{\n"
    "  OFFSET 1 2 3\n"
    "  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
    "  JOINT knee\n"
    "  {\n"
    "    OFFSET 0 -5 0\n"
    "    CHANNELS 3 Zrotation Xrotation Yrotation\n"
    "    JOINT foot\n"
    "    {\n"
    "      OFFSET 0 -4 0\n"
    "      CHANNELS 3 Zrotation Xrotation Yrotation\n"
    "      End Site\n"
    "      {\n"
    "        OFFSET 0 -1 1\n"
    "      }\n"
    "    }\n"
    "  }\n"
    "}\n"
    "MOTION\n"
    "Frames: 3\n"
    "Frame Time: 0.04\n"
    "1 2 3 4 5 6 7 8 9 10 11 12\n"
    "2 2 3 4 5 6 7 8 9 10 11 12\n"
    "3 2 3 4 5 6 7 8 9 10 11 12\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  EXPECT_NE(text.find(from), std::string::npos) << from;
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string utf16(const std::string& text, bool big_endian, bool mark) {
  std::string bytes = mark ? (big_endian ? "\xFE\xFF" : "\xFF\xFE") : "";
  for (const char c : text) {
    if (big_endian) bytes += '\0';
    bytes += c;
    if (!big_endian) bytes += '\0';
  }
  return bytes;
}

void expect_same(const formats::Bvh& bvh, const std::string& what) {
  const formats::Bvh plain = formats::parse_bvh(kPlain, "plain.bvh");
  EXPECT_EQ(bvh.values, plain.values) << what;
  EXPECT_EQ(bvh.frames, plain.frames) << what;
  EXPECT_EQ(bvh.frame_time, plain.frame_time) << what;
  ASSERT_EQ(bvh.joints.size(), plain.joints.size()) << what;
  for (size_t j = 0; j < plain.joints.size(); ++j) {
    EXPECT_EQ(lower(bvh.joints[j].name), plain.joints[j].name) << what;
    EXPECT_EQ(bvh.joints[j].parent, plain.joints[j].parent) << what;
    EXPECT_EQ(bvh.joints[j].offset, plain.joints[j].offset) << what;
    EXPECT_EQ(bvh.joints[j].channels, plain.joints[j].channels) << what;
    EXPECT_EQ(bvh.joints[j].first_channel, plain.joints[j].first_channel) << what;
    EXPECT_EQ(bvh.joints[j].end_site, plain.joints[j].end_site) << what;
  }
}

bool mentions(const std::vector<std::string>& warnings, const std::string& part) {
  for (const std::string& warning : warnings) {
    if (warning.find(part) != std::string::npos) return true;
  }
  return false;
}

std::string error_of_bvh(const std::string& text, const formats::BvhReading& reading = {}) {
  try {
    formats::parse_bvh(text, "x.bvh", reading);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(BvhTolerance, SpellingsOfTheSameFileReadTheSame) {
  const std::pair<const char*, std::string> cases[] = {
      {"upper case", upper(kPlain)},
      {"lower case", lower(kPlain)},
      {"CR", replaced(kPlain, "\n", "\r")},
      {"CR LF", replaced(kPlain, "\n", "\r\n")},
      {"blank lines and tabs", "\n\n \t\n" + replaced(kPlain, "\n", " \t\n\n\t")},
      {"name after End Site", replaced(kPlain, "End Site", "End Site tip of foot")},
      {"other case of End Site", replaced(kPlain, "End Site", "End site")},
      {"End Site in one word", replaced(kPlain, "End Site", "EndSite")},
      {"End Site with its brace", replaced(kPlain, "End Site\n      {", "End Site {")},
      {"End Site with channels", replaced(kPlain, "OFFSET 0 -1 1", "OFFSET 0 -1 1\nCHANNELS 0")},
      {"no blank after Frames:", replaced(kPlain, "Frames: ", "Frames:")},
      {"blank before the colon", replaced(kPlain, "Frames: ", "Frames : ")},
      {"no blank after Frame Time:", replaced(kPlain, "Frame Time: ", "Frame Time:")},
      {"Frame Time in one word", replaced(kPlain, "Frame Time: ", "FrameTime : ")},
      {"Frame Time first",
       replaced(kPlain, "Frames: 3\nFrame Time: 0.04", "Frame Time: .04\nFrames: 3")},
      {"tab after the colon", replaced(kPlain, "Time: ", "Time:\t")},
      {"zeros that fill a block", kPlain + std::string(64, '\0')},
      {"the end of a file of DOS", kPlain + "\x1a"},
      {"UTF-8 with mark", "\xEF\xBB\xBF" + kPlain},
      {"UTF-16, little-endian", utf16(kPlain, false, true)},
      {"UTF-16, big-endian", utf16(kPlain, true, true)},
      {"UTF-16 without mark", utf16(kPlain, false, false)},
      {"big-endian UTF-16 without mark", utf16(kPlain, true, false)},
      {"CHANNELS before OFFSET",
       replaced(kPlain, "    OFFSET 0 -5 0\n    CHANNELS 3 Zrotation Xrotation Yrotation\n",
                "    CHANNELS 3 Zrotation Xrotation Yrotation\n    OFFSET 0 -5 0\n")},
  };
  for (const auto& [what, text] : cases) {
    const formats::Bvh bvh = formats::parse_bvh(text, "x.bvh");
    expect_same(bvh, what);
    EXPECT_TRUE(bvh.warnings.empty()) << what << ": " << bvh.warnings[0];
  }
}

TEST(BvhTolerance, LinesAreCountedWhateverEndsThem) {
  for (const char* end : {"\n", "\r", "\r\n"}) {
    const std::string text = replaced(replaced(kPlain, "2 2 3", "2 nan 3"), "\n", end);
    EXPECT_NE(error_of_bvh(text).find("x.bvh:25: value 2 of the frame is \"nan\""),
              std::string::npos)
        << error_of_bvh(text);
  }
}

TEST(BvhTolerance, ScaleChannelsAreLeftOut) {
  std::string text = replaced(kPlain, "CHANNELS 3 Zrotation Xrotation Yrotation",
                              "CHANNELS 6 xscale Zrotation Xrotation YSCALE Yrotation Zscale");
  text = replaced(text, "7 8 9 10 11 12", "1 7 8 1 9 1 1 10 11 1 12 1");
  const formats::Bvh bvh = formats::parse_bvh(text, "x.bvh");
  expect_same(bvh, "scales");
  EXPECT_TRUE(mentions(bvh.warnings, "x.bvh:9: the scale channels"));
}

TEST(BvhTolerance, AWrongNumberOfFramesIsAWarning) {
  for (const char* count :
       {"2", "4", "0", "-3", "1.5", "999999999999", "99999999999999999999", "x"}) {
    const formats::Bvh bvh =
        formats::parse_bvh(replaced(kPlain, "Frames: 3", std::string("Frames: ") + count), "x.bvh");
    expect_same(bvh, count);
    EXPECT_TRUE(mentions(bvh.warnings, std::string("x.bvh:22: Frames: says ") + count)) << count;
    EXPECT_TRUE(mentions(bvh.warnings, "holds 3")) << count;
  }
  const formats::Bvh bvh = formats::parse_bvh(replaced(kPlain, "Frames: 3\n", ""), "x.bvh");
  expect_same(bvh, "no line Frames:");
  EXPECT_TRUE(mentions(bvh.warnings, "no line \"Frames:\""));
}

TEST(BvhTolerance, ANumberOfFramesThatIsLeftOutIsAWarning) {
  const formats::Bvh bvh = formats::parse_bvh(replaced(kPlain, "Frames: 3", "Frames:"), "x.bvh");
  expect_same(bvh, "no number of frames");
  EXPECT_TRUE(mentions(bvh.warnings, "Frames: says nothing, the file holds 3"));
}

TEST(BvhTolerance, JointsOfTheSameNameAreRenamed) {
  const formats::Bvh bvh =
      formats::parse_bvh(replaced(kPlain, "JOINT foot", "JOINT knee"), "x.bvh");
  EXPECT_EQ(bvh.joints[1].name, "knee");
  EXPECT_EQ(bvh.joints[2].name, "knee.001");
  EXPECT_TRUE(mentions(bvh.warnings, "x.bvh:10: a second joint is named \"knee\""));
}

TEST(BvhTolerance, OneOfSeveralSkeletonsIsChosenByItsRoot) {
  const size_t begin = kPlain.find("ROOT"), end = kPlain.find("MOTION");
  const std::string body = kPlain.substr(begin, end - begin);
  std::string text = kPlain;
  text.insert(end, replaced(body, "OFFSET 0 -5 0", "OFFSET 0 -7 0"));
  text = replaced(text, "7 8 9 10 11 12\n", "7 8 9 10 11 12 9 8 7 6 5 4 3 2 1 0 -1 -2\n");

  const std::string refusal = error_of_bvh(text);
  EXPECT_NE(refusal.find("x.bvh:21: a second ROOT"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("\"hip\", \"hip.001\""), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("--root NAME"), std::string::npos) << refusal;

  expect_same(formats::parse_bvh(text, "x.bvh", {.root = "hip"}), "the first");
  const formats::Bvh second = formats::parse_bvh(text, "x.bvh", {.root = "hip.001"});
  ASSERT_EQ(second.joints.size(), 3u);
  EXPECT_EQ(second.joints[0].name, "hip");  // as its file calls it
  EXPECT_EQ(second.joints[1].parent, 0);
  EXPECT_EQ(second.joints[1].offset.y(), -7);
  EXPECT_EQ(second.channels, 12);
  EXPECT_EQ(second.values[0], 9);
  EXPECT_EQ(second.values[11], -2);
  EXPECT_TRUE(second.warnings.empty());
  EXPECT_NE(error_of_bvh(text, {.root = "foot"}).find("the roots are \"hip\", \"hip.001\""),
            std::string::npos);
  expect_same(formats::parse_bvh(kPlain, "x.bvh", {.root = "hip"}), "the only one");
}

TEST(BvhTolerance, AKnownRateMakesUpForTheFrameTime) {
  for (const char* time :
       {"Frame Time: 0", "Frame Time: 30", "Frame Time: x", "Frame Time: nan", "Frame Time:"}) {
    const std::string text = replaced(kPlain, "Frame Time: 0.04", time);
    EXPECT_NE(error_of_bvh(text).find("--fps"), std::string::npos) << time;
    EXPECT_EQ(formats::parse_bvh(text, "x.bvh", {.frame_time_known = true}).frame_time, 0) << time;
  }
  const std::string without = replaced(kPlain, "Frame Time: 0.04\n", "");
  EXPECT_NE(error_of_bvh(without).find("--fps"), std::string::npos);
  EXPECT_EQ(formats::parse_bvh(without, "x.bvh", {.frame_time_known = true}).frames, 3);
}

TEST(BvhTolerance, NumbersBeyondADoubleAreZeroOrRefused) {
  const formats::Bvh bvh = formats::parse_bvh(replaced(kPlain, "1 2 3 4", "1e-400 2 3 4"), "x.bvh");
  EXPECT_EQ(bvh.values[0], 0);
  EXPECT_NE(error_of_bvh(replaced(kPlain, "1 2 3 4", "1e400 2 3 4")).find("too large"),
            std::string::npos);
}

}  // namespace remomask
