#include "exchange/humanml_folder.h"
#include "motion/vector.h"

#include <algorithm>

#include "base/file.h"
#include "exchange/humanml_texts.h"
#include "formats/npy.h"
#include "motion/canonical.h"
#include "motion/features.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

void write_joints(const std::string& path, const Motion& motion) {
  write_file_atomically(path, formats::format_npy({{static_cast<size_t>(motion.frames),
                                                    static_cast<size_t>(motion.joints), 3},
                                                   motion.positions}));
}

void make_layout(const TestFolder& folder) {
  for (const char* name : {"new_joints", "new_joint_vecs", "texts"}) {
    std::filesystem::create_directories(folder / (std::string("set/") + name));
  }
  write_file_atomically(folder / "set/train.txt", "000001\nM000001\n000002\n\n");
  write_file_atomically(folder / "set/val.txt", "000003\r\nghost\n");
  write_file_atomically(folder / "set/test.txt", "000002\n");
}

bool warned(const exchange::ImportReport& report, const std::string& part) {
  return std::any_of(report.warnings.begin(), report.warnings.end(),
                     [&](const std::string& text) { return text.find(part) != text.npos; });
}

TEST(HumanmlFolder, JointsTextsSplitsTagsAndMirrors) {
  TestFolder folder;
  make_layout(folder);
  const Motion first = walking_motion(60, 1), second = walking_motion(199, 2);
  write_joints(folder / "set/new_joints/000001.npy", first);
  write_joints(folder / "set/new_joints/M000001.npy",
               motion::mirror_motion(first, humanml_skeleton()));
  write_joints(folder / "set/new_joints/000002.npy", second);
  // Only features: positions are recovered from them.
  const motion::Features features = motion::extract_features(
      walking_motion(41, 3), humanml_skeleton(), motion::FeatureMode::official);
  write_file_atomically(folder / "set/new_joint_vecs/000003.npy",
                        formats::format_npy({{40, 263}, features.values}));
  write_file_atomically(folder / "set/texts/000001.txt",
                        "a man walks#a/DET man/NOUN#0.0#0.0\n"
                        "he swings his arms#he/PRON#1.0#2.5\n"
                        "arms swing#arm/NOUN#1.0#2.5\n"
                        "all of it#all/DET#0.0#3.0\n"
                        "he nods#he/PRON#2.5#2.9\n");
  write_file_atomically(folder / "set/texts/M000001.txt", "a man walks#a/DET#nan#nan\n");
  write_file_atomically(folder / "set/texts/000002.txt", "broken line#tokens\n");
  write_file_atomically(folder / "set/texts/000009.txt", "nobody#x#0.0#0.0\n");

  exchange::ImportOptions options;
  options.folder = folder / "set";
  options.source = "humanml3d";
  db::Database database(folder / "d", db::OpenMode::create);
  const exchange::ImportReport report = exchange::import_folder(database, options);
  EXPECT_EQ(report.files, 4);
  EXPECT_EQ(report.files_stored, 3);
  ASSERT_EQ(report.rejected.size(), 1u);
  EXPECT_EQ(report.rejected[0].file, "new_joints/000002.npy");
  EXPECT_NE(report.rejected[0].reason.find("texts/000002.txt:1: is not of the form"),
            std::string::npos);

  const db::Clip whole = database.clip(*database.find_name("000001"));
  EXPECT_EQ(whole.captions, (std::vector<std::string>{"a man walks", "all of it"}));
  EXPECT_EQ(whole.split, "train");
  EXPECT_EQ(whole.group, "humanml3d/000001");
  EXPECT_FALSE(whole.mirrored);
  EXPECT_EQ(database.motion(whole.id).positions, first.positions);

  const db::Clip part = database.clip(*database.find_name("000001@1-2.5"));
  EXPECT_EQ(part.captions, (std::vector<std::string>{"he swings his arms", "arms swing"}));
  EXPECT_EQ(part.start_frame, 20);
  EXPECT_EQ(part.frames, 30);
  EXPECT_EQ(part.group, whole.group);
  EXPECT_EQ(part.source_file, "000001");
  EXPECT_TRUE(warned(report, "000001@2.5-2.9 has 8 frames"));

  const db::Clip mirrored = database.clip(*database.find_name("M000001"));
  EXPECT_TRUE(mirrored.mirrored);
  EXPECT_EQ(mirrored.group, whole.group);
  EXPECT_EQ(mirrored.split, "train");

  const db::Clip recovered = database.clip(*database.find_name("000003"));
  EXPECT_EQ(recovered.frames, 40);
  EXPECT_EQ(recovered.split, "none");
  EXPECT_TRUE(recovered.captions.empty());
  EXPECT_TRUE(warned(report, "texts/000003.txt: is missing"));
  EXPECT_EQ(database.motion(recovered.id).positions,
            motion::recover_motion(features, humanml_skeleton()).positions);

  EXPECT_TRUE(warned(report, "texts/000009.txt: has no motion file"));
  EXPECT_TRUE(warned(report, "val.txt:2: clip 'ghost' has no motion file"));
  EXPECT_TRUE(warned(report, "test.txt:1: clip '000002' is in the split 'train' already"));
  EXPECT_EQ(report.warnings.size(), 5u);

  const int64_t generation = database.generation();
  EXPECT_EQ(exchange::import_folder(database, options).files_known, 3);
  EXPECT_EQ(database.generation(), generation);
  // A corrected text brings the clip in; 199 frames stay one clip.
  write_file_atomically(folder / "set/texts/000002.txt", "a man runs#a/DET#0.0#0.0");
  EXPECT_EQ(exchange::import_folder(database, options).clips_stored, 1);
  EXPECT_EQ(database.clip(*database.find_name("000002")).frames, 199);
}

TEST(HumanmlFolder, KitSkeleton) {
  TestFolder folder;
  make_layout(folder);
  const Skeleton& kit = kit_skeleton();
  Motion motion(30, 21);
  for (int frame = 0; frame < 30; ++frame) {
    set_joint_position(motion, frame, 0, Vec3(0, 800, 5 * frame));
    for (int joint = 1; joint < 21; ++joint) {
      const auto j = static_cast<size_t>(joint);
      set_joint_position(
          motion, frame, joint,
          joint_position(motion, frame, kit.parents[j]) + 100 * rest_direction(kit, j));
    }
  }
  write_joints(folder / "set/new_joints/000001.npy", motion);
  write_file_atomically(folder / "set/texts/000001.txt", "a man walks#a/DET#0.0#0.0\n");
  exchange::ImportOptions options;
  options.folder = folder / "set";
  db::Database database(folder / "d", db::OpenMode::create);
  EXPECT_EQ(exchange::import_folder(database, options).files_stored, 1);
  const db::Clip clip = database.clip(*database.find_name("000001"));
  EXPECT_EQ(clip.skeleton, "kit");
  EXPECT_EQ(database.motion(clip.id).joints, 21);
}

TEST(HumanmlFolder, OtherShapesAndOptionsAreRefused) {
  TestFolder folder;
  make_layout(folder);
  write_file_atomically(folder / "set/new_joints/000001.npy",
                        formats::format_npy({{30, 23, 3}, std::vector<float>(30 * 23 * 3, 0.f)}));
  exchange::ImportOptions options;
  options.folder = folder / "set";
  db::Database database(folder / "d", db::OpenMode::create);
  const exchange::ImportReport report = exchange::import_folder(database, options);
  ASSERT_EQ(report.rejected.size(), 1u);
  EXPECT_NE(report.rejected[0].reason.find("shape (30, 23, 3)"), std::string::npos);
  options.captions_file = folder / "set/train.txt";
  EXPECT_NE(error_of([&] { exchange::import_folder(database, options); }).find("its own texts"),
            std::string::npos);
}

TEST(HumanmlTexts, WrongLinesAreNamed) {
  TestFolder folder;
  const std::string path = folder / "t.txt";
  std::vector<std::string> warnings;
  const auto error_with = [&](const std::string& content) {
    write_file_atomically(path, content);
    return error_of([&] { exchange::read_humanml_texts(path, warnings); });
  };
  EXPECT_EQ(error_with("a#b#0.0#0.0\n\n c #d#1#2\n"), "");
  EXPECT_NE(error_with("\na#b#x#2\n").find("t.txt:2: 'x' is not a time"), std::string::npos);
  EXPECT_NE(error_with("a#b#0,5#2\n").find("like 2.5"), std::string::npos);
  EXPECT_NE(error_with("a#b#2#1\n").find("ends before it begins"), std::string::npos);
  EXPECT_NE(error_with("a#b#-1#1\n").find("not a time"), std::string::npos);
  EXPECT_NE(error_with("#b#0#1\n").find("not of the form"), std::string::npos);
  const auto parts = [&] {
    write_file_atomically(path, "one#t#0#0\r\ntwo#t#1.5#2\r\nthree#t#nan#nan\r\n");
    return exchange::read_humanml_texts(path, warnings);
  }();
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].captions, (std::vector<std::string>{"one", "three"}));
  EXPECT_EQ(parts[1].from, 1.5);
  EXPECT_TRUE(warnings.empty());
}

TEST(HumanmlTexts, ABadLineCostsOneLine) {
  TestFolder folder;
  const std::string path = folder / "t.txt";
  write_file_atomically(path, "one#t#0#0\nno fields\ntwo#t#2#1\nthree#t#0#0\n");
  std::vector<std::string> warnings;
  const auto parts = exchange::read_humanml_texts(path, warnings);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(parts[0].captions, (std::vector<std::string>{"one", "three"}));
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("t.txt:2: is not of the form"), std::string::npos);
  EXPECT_NE(warnings[1].find("t.txt:3: the part ends before"), std::string::npos);
}

TEST(HumanmlTexts, FieldsAreCountedFromTheRight) {
  TestFolder folder;
  const std::string path = folder / "t.txt";
  const auto caption_of = [&](const std::string& content) {
    write_file_atomically(path, content);
    std::vector<std::string> warnings;
    const auto parts = exchange::read_humanml_texts(path, warnings);
    EXPECT_TRUE(warnings.empty());
    return parts[0].captions[0];
  };
  EXPECT_EQ(caption_of("do exercise #1 of the list#do/VERB exercise/NOUN#0.0#0.0\n"),
            "do exercise #1 of the list");
  EXPECT_EQ(caption_of("exercise #1#exercise/NOUN #/SYM 1/NUM#0.0#0.0\n"), "exercise #1");
  EXPECT_EQ(caption_of("exercise #1#exercise/NOUN #1/NUM#nan#nan\n"), "exercise #1");
  EXPECT_EQ(caption_of("# one # two#tokens#1#2\n"), "# one # two");
  EXPECT_EQ(caption_of("a walk##0#0\n"), "a walk");
  EXPECT_EQ(caption_of("\xEF\xBB\xBF"
                       "a walk#a/DET#0#0\r\n"),
            "a walk");
  std::string utf16 = "\xFF\xFE";
  for (const char c : std::string("a walk#t#0#0\r\n")) utf16 += {c, '\0'};
  EXPECT_EQ(caption_of(utf16), "a walk");
}

TEST(HumanmlFolder, SplitFilesOfWindowsAndRepeatedIds) {
  TestFolder folder;
  make_layout(folder);
  write_joints(folder / "set/new_joints/000001.npy", walking_motion(30, 1));
  write_file_atomically(folder / "set/texts/000001.txt",
                        "\xEF\xBB\xBF"
                        "a man walks#a/DET#0#0\r\n");
  write_file_atomically(folder / "set/train.txt",
                        "\xEF\xBB\xBF"
                        "000001\t\r000001.npy \r\n");
  write_file_atomically(folder / "set/val.txt", "");
  write_file_atomically(folder / "set/test.txt", "");
  exchange::ImportOptions options;
  options.folder = folder / "set";
  db::Database database(folder / "d", db::OpenMode::create);
  const exchange::ImportReport report = exchange::import_folder(database, options);
  const db::Clip clip = database.clip(*database.find_name("000001"));
  EXPECT_EQ(clip.split, "train");
  EXPECT_EQ(clip.captions, (std::vector<std::string>{"a man walks"}));
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("train.txt:2: clip '000001' is listed in line 1 already"),
            std::string::npos);
}

}  // namespace
}  // namespace remomask
