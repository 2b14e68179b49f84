#include "exchange/import.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "base/file.h"
#include "db/sqlite.h"
#include "motion/canonical.h"
#include "remomask/motion_file.h"
#include "remomask/rotations.h"
#include "rig/forward_kinematics.h"
#include "tests/db/db_test_tools.h"
#include "tests/exchange/import_test_tools.h"

namespace remomask {
namespace {

std::string reason_of(const exchange::ImportReport& report, const std::string& file) {
  for (const RejectedFile& rejected : report.rejected) {
    if (rejected.file == file) return rejected.reason;
  }
  return "";
}

std::string integrity(const std::string& path) {
  const db::SqliteConnection connection(path, db::SqliteMode::read_only);
  db::SqliteStatement check(connection, "PRAGMA integrity_check");
  check.step();
  return check.text(0);
}

TEST(Import, BvhFolderWithCaptions) {
  TestFolder folder;
  const exchange::ImportOptions options = make_walks(folder, 5, ".bvh");
  db::Database database(folder / "d", db::OpenMode::create);
  double done = 0, total = 0;
  Monitor monitor;
  monitor.progress = [&](const Progress& progress) {
    EXPECT_EQ(progress.stage, "import walks");
    EXPECT_GT(progress.done, done);
    done = progress.done;
    total = progress.total;
  };
  const exchange::ImportReport report = exchange::import_folder(database, options, monitor);
  EXPECT_EQ(report.files, 5);
  EXPECT_EQ(report.files_stored, 5);
  EXPECT_EQ(report.clips_stored, 5);
  EXPECT_EQ(report.clips_windowed, 0);
  EXPECT_GT(report.bytes_read, 1000u);
  EXPECT_TRUE(report.rejected.empty());
  EXPECT_TRUE(report.warnings.empty());
  EXPECT_NEAR(done, total, 1e-9);
  const auto id = database.find_name("walk_1004");
  ASSERT_TRUE(id);
  const db::Clip clip = database.clip(*id);
  EXPECT_EQ(clip.source, "walks");
  EXPECT_EQ(clip.split, "test");
  EXPECT_EQ(clip.licence, "CC0");
  EXPECT_EQ(clip.group, "walks/walk_1004");
  EXPECT_EQ(clip.captions, (std::vector<std::string>{"the motion walk_1004", "it is walk_1004"}));
  EXPECT_EQ(clip.labels.at("number"), 4);
  EXPECT_EQ(clip.frames, 28);
  // The body of the motion bends where the skeleton of a file does not.
  const Motion rigid = motion::canonicalize(
      rig::joint_positions(solve_rotations(walking_motion(28, 4), {.keep_rigid = true})),
      humanml_skeleton());
  const Motion stored = database.motion(*id);
  ASSERT_EQ(stored.frames, rigid.frames);
  for (size_t i = 0; i < stored.positions.size(); ++i) {
    ASSERT_NEAR(stored.positions[i], rigid.positions[i], 0.001) << i;
  }
}

TEST(Import, SecondImportChangesNothing) {
  TestFolder folder;
  const exchange::ImportOptions options = make_walks(folder, 6, ".npy");
  write_file_atomically(folder / "walks/broken.bvh", "HIERARCHY\n");
  db::Database database(folder / "d", db::OpenMode::create);
  const exchange::ImportReport first = exchange::import_folder(database, options);
  const int64_t generation = database.generation();
  const exchange::ImportReport second = exchange::import_folder(database, options);
  EXPECT_EQ(database.generation(), generation);
  EXPECT_EQ(second.files_known, 6);
  EXPECT_EQ(second.files_stored, 0);
  EXPECT_EQ(second.clips_stored, 0);
  EXPECT_EQ(reason_of(second, "broken.bvh"), reason_of(first, "broken.bvh"));
  EXPECT_NE(reason_of(second, "broken.bvh"), "");
}

TEST(Import, ThreadsAndOrderDoNotMatter) {
  TestFolder folder;
  exchange::ImportOptions options = make_walks(folder, 20, ".npy");
  db::Database one(folder / "one", db::OpenMode::create),
      many(folder / "many", db::OpenMode::create);
  options.threads = 1;
  exchange::import_folder(one, options);
  options.threads = 7;
  exchange::import_folder(many, options);
  EXPECT_EQ(describe_database(one), describe_database(many));
}

TEST(Import, ChangedCaptionsReplaceTheClip) {
  TestFolder folder;
  const exchange::ImportOptions options = make_walks(folder, 2, ".npy");
  db::Database database(folder / "d", db::OpenMode::create);
  exchange::import_folder(database, options);
  write_file_atomically(
      folder / "walks.jsonl",
      caption_line("walk_1000", "val") +
          caption_line("walk_1001", "train", {{"content", "walk"}, {"number", 1}}));
  const exchange::ImportReport report = exchange::import_folder(database, options);
  EXPECT_EQ(report.files_known, 1);
  EXPECT_EQ(report.files_stored, 1);
  EXPECT_TRUE(any_contains(report.warnings, "walk_1000.npy: the file, its description"));
  EXPECT_EQ(database.clip_count(), 2);
  EXPECT_EQ(database.clip(*database.find_name("walk_1000")).split, "val");
}

TEST(Import, RemovedClipsComeBack) {
  TestFolder folder;
  const exchange::ImportOptions options = make_walks(folder, 2, ".npy");
  db::Database database(folder / "d", db::OpenMode::create);
  exchange::import_folder(database, options);
  const nlohmann::json before = describe_database(database);
  EXPECT_EQ(database.remove_clips("walks", "walk_1001"), 1);
  EXPECT_EQ(exchange::import_folder(database, options).files_stored, 1);
  EXPECT_EQ(describe_database(database), before);
}

TEST(Import, OddFilesAreReadWithAWarning) {
  TestFolder folder;
  const exchange::ImportOptions options = make_walks(folder, 1, ".bvh");
  const std::string path = folder / "walks/deeper/walk_1000.bvh";
  std::string text = read_file(path);
  text.replace(text.find("Frames: 24"), 10, "Frames: 99");
  write_file_atomically(path, text);
  db::Database database(folder / "d", db::OpenMode::create);
  const exchange::ImportReport report = exchange::import_folder(database, options);
  EXPECT_EQ(report.files_stored, 1);
  EXPECT_TRUE(any_contains(report.warnings, "deeper/walk_1000.bvh:"));
  EXPECT_TRUE(any_contains(report.warnings, "Frames: says 99, the file holds 24"));
}

TEST(Import, ARateOfTheUserOrOfTheLabelsMendsThatOfTheFile) {
  TestFolder folder;
  exchange::ImportOptions options = make_walks(folder, 1, ".bvh");
  options.min_frames = 10;
  const std::string path = folder / "walks/deeper/walk_1000.bvh";
  const std::string text = read_file(path);
  const auto frames_of = [&](const std::string& frame_time, const nlohmann::json& labels) {
    std::string changed = text;
    const size_t at = changed.find("Frame Time: ") + 12;
    changed.replace(at, changed.find('\n', at) - at, frame_time);
    write_file_atomically(path, changed);
    write_file_atomically(folder / "walks.jsonl", caption_line("walk_1000", "train", labels));
    db::Database database(folder / "d", db::OpenMode::create);
    const exchange::ImportReport report = exchange::import_folder(database, options);
    const int frames =
        report.files_stored == 1 ? database.clip(*database.find_name("walk_1000")).frames : -1;
    const bool warned = any_contains(report.warnings, "frames a second of its labels");
    std::filesystem::remove(folder / "d");
    return std::pair(frames, warned);
  };
  const nlohmann::json none = nlohmann::json::object();
  EXPECT_EQ(frames_of("0.05", none), std::pair(24, false));
  EXPECT_EQ(frames_of("0.05", {{"fps", 20.01}}), std::pair(24, false));  // rounded
  EXPECT_EQ(frames_of("0.05", {{"fps", 40}}), std::pair(12, true));
  EXPECT_EQ(frames_of("0", {{"fps", 40}}), std::pair(12, false));
  EXPECT_EQ(frames_of("0", none), std::pair(-1, false));
  options.fps = 40;
  EXPECT_EQ(frames_of("0", {{"fps", 20}}), std::pair(12, false));
}

TEST(Import, RejectedFilesAreNamedWithTheirReason) {
  TestFolder folder;
  const exchange::ImportOptions options = make_walks(folder, 1, ".npy");
  save_motion(folder / "walks/copy.npy", walking_motion(24, 0));
  save_motion(folder / "walks/short.npy", walking_motion(19, 3));
  save_motion(folder / "walks/labels.npy", walking_motion(30, 4));
  write_file_atomically(folder / "walks/stranger.bvh",
                        "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition "
                        "Zposition\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 1\nFrame "
                        "Time: 0.05\n0 0 0\n");
  write_file_atomically(folder / "walks.jsonl",
                        caption_line("copy") + caption_line("walk_1000") + caption_line("short") +
                            caption_line("labels", "train", {{"skip_frames", "two"}}) +
                            caption_line("stranger"));
  db::Database database(folder / "d", db::OpenMode::create);
  const exchange::ImportReport report = exchange::import_folder(database, options);
  EXPECT_EQ(report.files, 5);
  EXPECT_EQ(report.files_stored, 1);
  EXPECT_EQ(report.rejected.size(), 4u);
  EXPECT_EQ(reason_of(report, "short.npy"),
            "has 19 frames at 20 per second, at least 20 are needed");
  EXPECT_NE(reason_of(report, "labels.npy").find("walks.jsonl:4: label 'skip_frames'"),
            std::string::npos);
  EXPECT_NE(reason_of(report, "stranger.bvh").find("skeleton"), std::string::npos);
  // Whichever comes first by its path is stored.
  EXPECT_NE(reason_of(report, "deeper/walk_1000.npy").find("same motion as 'copy' of 'walks'"),
            std::string::npos);
  EXPECT_TRUE(any_contains(report.warnings, "2 captions that 'copy' does not have"));
}

TEST(Import, NamesTakenByAnotherSourceAreRefused) {
  TestFolder folder;
  const exchange::ImportOptions options = make_walks(folder, 2, ".npy");
  db::Database database(folder / "d", db::OpenMode::create);
  db::Clip other = named_clip("walk_1001");
  other.source = "other";
  database.add_clip(other, walking_motion(50, 99));
  const exchange::ImportReport report = exchange::import_folder(database, options);
  EXPECT_EQ(report.files_stored, 1);
  EXPECT_NE(reason_of(report, "walk_1001.npy").find("is taken by a clip of 'other'"),
            std::string::npos);
}

TEST(Import, LongClipsBecomeWindowsOfOneGroup) {
  TestFolder folder;
  std::filesystem::create_directory(folder / "walks");
  const Motion motion = walking_motion(400, 5);
  save_motion(folder / "walks/long.npy", motion);
  write_file_atomically(folder / "captions.jsonl", caption_line("long", "val"));
  exchange::ImportOptions options;
  options.folder = folder / "walks/";
  options.captions_file = folder / "captions.jsonl";
  db::Database database(folder / "d", db::OpenMode::create);
  const exchange::ImportReport report = exchange::import_folder(database, options);
  EXPECT_EQ(report.files_stored, 1);
  EXPECT_EQ(report.clips_windowed, 3);
  const auto clips = database.clips();
  ASSERT_EQ(clips.size(), 3u);
  EXPECT_EQ(clips[0].name, "long#0");
  EXPECT_EQ(clips[2].name, "long#2");
  EXPECT_EQ(clips[1].start_frame, 156);
  EXPECT_EQ(clips[2].start_frame, 204);
  for (const db::Clip& clip : clips) {
    EXPECT_EQ(clip.group, "walks/long");
    EXPECT_EQ(clip.source_file, "long");
    EXPECT_EQ(clip.frames, 196);
    EXPECT_EQ(clip.split, "val");
    EXPECT_EQ(clip.captions.size(), 2u);
    const Motion window = database.motion(clip.id);
    EXPECT_NEAR(window.at(0, 0)[0], 0, 1e-5);
    EXPECT_NEAR(window.at(0, 0)[2], 0, 1e-5);
  }
}

TEST(Import, LabelsReadTheFileAndFormGroups) {
  TestFolder folder;
  std::filesystem::create_directory(folder / "walks");
  const Motion motion = walking_motion(60, 5);
  for (const char* name : {"a", "b", "c"}) {
    save_motion(folder / (std::string("walks/") + name + ".bvh"), motion);
  }
  write_file_atomically(
      folder / "walks.jsonl",
      caption_line("a", "train", {{"skip_frames", 10}, {"trial", "02_01"}, {"licence", "MIT"}}) +
          caption_line("b", "none", {{"skip_frames", 20}, {"skeleton", "no_such_map"}}) +
          caption_line("c", "train", {{"duplicate_of", "walks/b"}}));
  exchange::ImportOptions options;
  options.folder = folder / "walks";
  options.licence = "CC0";
  db::Database database(folder / "d", db::OpenMode::create);
  const exchange::ImportReport report = exchange::import_folder(database, options);
  ASSERT_EQ(report.files_stored, 3);
  const auto clips = database.clips();
  EXPECT_EQ(clips[0].frames, 50);
  EXPECT_EQ(clips[0].group, "trial/02_01");
  EXPECT_EQ(clips[0].licence, "MIT");
  EXPECT_EQ(clips[1].frames, 40);
  EXPECT_EQ(clips[1].group, "walks/b");
  EXPECT_EQ(clips[1].split, "none");
  EXPECT_EQ(clips[1].licence, "CC0");
  EXPECT_EQ(clips[2].group, "walks/b");
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_TRUE(any_contains(report.warnings, "b.bvh: skeleton 'no_such_map' of its labels"));
}

TEST(Import, TheSameStemTwiceIsToldApartByThePath) {
  TestFolder folder;
  std::filesystem::create_directories(folder / "walks/x");
  save_motion(folder / "walks/x/a.npy", walking_motion(30, 1));
  save_motion(folder / "walks/a.npy", walking_motion(30, 2));
  save_motion(folder / "walks/x/b.npy", walking_motion(30, 3));
  save_motion(folder / "walks/x/b.bvh", walking_motion(30, 4));
  write_file_atomically(
      folder / "walks/captions.jsonl",
      caption_line("x/a", "val") + caption_line("a", "test") + caption_line("x/b", "test"));
  exchange::ImportOptions options;
  options.folder = folder / "walks";
  db::Database database(folder / "d", db::OpenMode::create);
  const exchange::ImportReport report = exchange::import_folder(database, options);
  EXPECT_TRUE(report.warnings.empty());
  EXPECT_EQ(database.clip(*database.find_name("x/a")).split, "val");
  EXPECT_EQ(database.clip(*database.find_name("a")).split, "test");
  EXPECT_EQ(database.clip(*database.find_name("x/b.npy")).split, "test");
  EXPECT_EQ(database.clip(*database.find_name("x/b.bvh")).split, "test");
}

TEST(Import, InterruptedImportGoesOnToTheSameResult) {
  TestFolder folder;
  const exchange::ImportOptions options = make_walks(folder, 30, ".npy");
  db::Database whole(folder / "whole", db::OpenMode::create),
      parts(folder / "parts", db::OpenMode::create);
  exchange::import_folder(whole, options);
  std::stop_source stop;
  Monitor monitor;
  monitor.stop = stop.get_token();
  int seen = 0;
  monitor.progress = [&](const Progress&) {
    if (++seen == 11) stop.request_stop();
  };
  EXPECT_THROW(exchange::import_folder(parts, options, monitor), Interrupted);
  EXPECT_EQ(parts.clip_count(), 11);
  const exchange::ImportReport rest = exchange::import_folder(parts, options);
  EXPECT_EQ(rest.files_known, 11);
  EXPECT_EQ(rest.files_stored, 19);
  EXPECT_EQ(describe_database(parts), describe_database(whole));
}

TEST(Import, KilledImportGoesOnToTheSameResult) {
  TestFolder folder;
  const exchange::ImportOptions options = make_walks(folder, 80, ".npy");
  const std::string path = folder / "killed";
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    int seen = 0;
    Monitor monitor;
    monitor.progress = [&](const Progress&) {
      if (++seen == 75) ::raise(SIGKILL);
    };
    db::Database database(path, db::OpenMode::create);
    exchange::import_folder(database, options, monitor);
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  EXPECT_EQ(integrity(path), "ok");
  db::Database killed(path, db::OpenMode::read_write),
      whole(folder / "whole", db::OpenMode::create);
  EXPECT_EQ(killed.clip_count(), 64);
  EXPECT_EQ(exchange::import_folder(killed, options).files_stored, 16);
  exchange::import_folder(whole, options);
  EXPECT_EQ(describe_database(killed), describe_database(whole));
}

TEST(Import, WrongOptionsAreNamed) {
  TestFolder folder;
  exchange::ImportOptions options = make_walks(folder, 1, ".npy");
  db::Database database(folder / "d", db::OpenMode::create);
  const auto error_with = [&](auto change) {
    exchange::ImportOptions changed = options;
    change(changed);
    return error_of([&] { exchange::import_folder(database, changed); });
  };
  EXPECT_NE(
      error_with([&](exchange::ImportOptions& o) { o.folder = folder / "none"; }).find("neither"),
      std::string::npos);
  EXPECT_NE(error_with([&](exchange::ImportOptions& o) {
              o.captions_file = folder / "none";
            }).find("no such captions file"),
            std::string::npos);
  EXPECT_NE(error_with([](exchange::ImportOptions& o) { o.threads = 0; }).find("thread"),
            std::string::npos);
  EXPECT_NE(error_with([](exchange::ImportOptions& o) { o.window_overlap = 190; }).find("overlap"),
            std::string::npos);
  std::filesystem::create_directory(folder / "empty");
  EXPECT_NE(
      error_with([&](exchange::ImportOptions& o) { o.folder = folder / "empty"; }).find("holds no"),
      std::string::npos);
  EXPECT_EQ(database.clip_count(), 0);
}

TEST(Import, RealPackWithManySkeletons) {
  const char* variable = std::getenv("REMOMASK_DATA");
  const std::string data = variable ? variable : REMOMASK_SOURCE_DIR "/../shared/data";
  if (!std::filesystem::exists(data + "/misc.tar.xz")) {
    GTEST_SKIP() << "no motion data at " << data << "; set REMOMASK_DATA";
  }
  TestFolder folder;
  db::Database database(folder / "d", db::OpenMode::create);
  exchange::ImportOptions options;
  options.folder = data + "/misc.tar.xz";
  options.threads = 2;
  const exchange::ImportReport report = exchange::import_folder(database, options);
  EXPECT_EQ(report.files, 14);
  EXPECT_EQ(report.files_stored, 13);
  // Not a human body.
  EXPECT_NE(reason_of(report, "importer_sinusoidal.bvh").find("skeleton"), std::string::npos);
  for (const std::string& warning : report.warnings) {
    EXPECT_NE(warning.find("rest pose"), std::string::npos) << warning;
  }
  const int64_t generation = database.generation();
  EXPECT_EQ(exchange::import_folder(database, options).files_known, 13);
  EXPECT_EQ(database.generation(), generation);
}

}  // namespace
}  // namespace remomask
