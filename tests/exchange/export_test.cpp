#include "exchange/export.h"

#include <cmath>

#include "base/file.h"
#include "exchange/add_files.h"
#include "exchange/import.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "synthetic/procedural.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

class ExportTest : public testing::Test {
 protected:
  void SetUp() override {
    synthetic::ProceduralOptions make;
    make.count = 4;
    for (const synthetic::ProceduralClip& made : synthetic::make_procedural_clips(make)) {
      db::Clip clip = named_clip(made.name);
      clip.captions = made.captions;
      clip.split = made.split;
      clip.tags = {"formula"};
      clip.group = "one/" + made.name.substr(0, 3);
      ids_.push_back(database_.add_clip(clip, made.motion));
    }
    db::Clip odd = named_clip("Dir/sub: \"walk\"#2");
    odd.licence = "CC-BY";
    // Labels on reading belong to the file that the clip once came from.
    odd.labels = {{"skip_frames", 3}, {"up_axis", "Z"}, {"metres_per_unit", 0.01}, {"trial", "7"}};
    odd.group = "trial/7";
    ids_.push_back(database_.add_clip(odd, walking_motion(200, 3)));
    db::Clip twin = named_clip("dir_sub_ _walk_#2");
    ids_.push_back(database_.add_clip(twin, walking_motion(60, 4)));
  }
  exchange::ImportReport import_into(db::Database& database, const std::string& folder) {
    exchange::ImportOptions options;
    options.folder = folder;
    options.source = "test";
    return exchange::import_folder(database, options);
  }
  /// Clips by name without what an import chooses anew.
  static std::map<std::string, nlohmann::json> by_name(const db::Database& database, bool exact) {
    std::map<std::string, nlohmann::json> all;
    for (const db::Clip& clip : database.clips()) {
      all[clip.name] = {clip.split,  clip.licence,  clip.group, clip.frames,
                        clip.labels, clip.captions, clip.tags};
      if (exact) all[clip.name].push_back(database.motion(clip.id).positions);
    }
    return all;
  }

  TestFolder folder_;
  db::Database database_{folder_ / "d", db::OpenMode::create};
  std::vector<int64_t> ids_;
};

TEST_F(ExportTest, NpyReturnsToTheSameClips) {
  exchange::export_clips(database_, ids_, folder_ / "out", exchange::ExportOptions{});
  db::Database again(folder_ / "again", db::OpenMode::create);
  const exchange::ImportReport report = import_into(again, folder_ / "out");
  EXPECT_TRUE(report.rejected.empty());
  EXPECT_TRUE(report.warnings.empty());
  EXPECT_EQ(by_name(again, true), by_name(database_, true));
  EXPECT_EQ(import_into(again, folder_ / "out").files_known, 6);
}

TEST_F(ExportTest, BvhReturnsWithinTwoCentimetres) {
  exchange::export_clips(database_, ids_, folder_ / "out", exchange::ExportOptions{".bvh", {}});
  db::Database again(folder_ / "again", db::OpenMode::create);
  const exchange::ImportReport report = import_into(again, folder_ / "out");
  EXPECT_TRUE(report.rejected.empty());
  EXPECT_EQ(by_name(again, false), by_name(database_, false));
  for (size_t i = 0; i < 4; ++i) {  // those of a body that moves as bones do
    const Motion before = database_.motion(ids_[i]);
    const Motion after = again.motion(*again.find_name(database_.clip(ids_[i]).name));
    double worst = 0;
    for (size_t v = 0; v < before.positions.size(); ++v) {
      worst = std::max<double>(worst, std::abs(before.positions[v] - after.positions[v]));
    }
    EXPECT_LT(worst, 0.02) << database_.clip(ids_[i]).name;
  }
}

TEST_F(ExportTest, WhatIsRigidStaysWithinAMillimetreInGlb) {
  const exchange::ExportOptions glb{".glb", {}};
  exchange::export_clips(database_, ids_, folder_ / "out", glb);
  db::Database first(folder_ / "first", db::OpenMode::create);
  EXPECT_TRUE(import_into(first, folder_ / "out").rejected.empty());
  EXPECT_EQ(by_name(first, false), by_name(database_, false));
  std::vector<int64_t> all;
  for (const db::Clip& clip : first.clips()) all.push_back(clip.id);
  exchange::export_clips(first, all, folder_ / "again", glb);
  db::Database second(folder_ / "second", db::OpenMode::create);
  EXPECT_TRUE(import_into(second, folder_ / "again").rejected.empty());
  for (const db::Clip& clip : first.clips()) {
    const Motion before = first.motion(clip.id);
    const Motion after = second.motion(*second.find_name(clip.name));
    ASSERT_EQ(before.positions.size(), after.positions.size());
    double worst = 0;
    for (size_t v = 0; v < before.positions.size(); ++v) {
      worst = std::max<double>(worst, std::abs(before.positions[v] - after.positions[v]));
    }
    EXPECT_LT(worst, 0.001) << clip.name;
  }
}

TEST_F(ExportTest, WritesTheChosenClipsAndMixesNothingUp) {
  exchange::export_clips(database_, {ids_[1]}, folder_ / "out", exchange::ExportOptions{});
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "out"), {}), 2);
  EXPECT_NE(error_of([&] {
              exchange::export_clips(database_, ids_, folder_ / "out", exchange::ExportOptions{});
            }).find("is not empty"),
            std::string::npos);
  EXPECT_THROW(exchange::export_clips(database_, {ids_.back() + 1}, folder_ / "other",
                                      exchange::ExportOptions{}),
               Error);
}

TEST_F(ExportTest, SingleFilesAreAdded) {
  std::filesystem::create_directory(folder_ / "files");
  save_motion(folder_ / "files/new.npy", database_.motion(ids_[0]));
  save_motion(folder_ / "files/long.bvh", walking_motion(500, 8));
  save_motion(folder_ / "files/short.npy", walking_motion(5, 8));
  db::Database again(folder_ / "again", db::OpenMode::create);
  exchange::AddOptions options;
  options.captions = {"a formula"};
  options.tags = {"t"};
  options.labels = {{"k", 1}};
  options.split = "val";
  options.licence = "MIT";
  const std::vector<std::string> files = {folder_ / "files/new.npy", folder_ / "files/short.npy",
                                          folder_ / "files/missing.npy",
                                          folder_ / "files/long.bvh"};
  const exchange::AddReport report = exchange::add_files(again, files, options);
  ASSERT_EQ(report.clips.size(), 4u);
  EXPECT_EQ(report.clips[0].second, "new");
  EXPECT_EQ(report.clips[3].second, "long#2");
  ASSERT_EQ(report.rejected.size(), 2u);
  EXPECT_NE(report.rejected[0].reason.find("5 frames"), std::string::npos);
  const db::Clip clip = again.clip(report.clips[3].first);
  EXPECT_EQ(clip.captions, options.captions);
  EXPECT_EQ(clip.tags, options.tags);
  EXPECT_EQ(clip.labels, options.labels);
  EXPECT_EQ(clip.split, "val");
  EXPECT_EQ(clip.licence, "MIT");
  EXPECT_EQ(clip.group, "added/long");
  EXPECT_EQ(clip.start_frame, 304);
  // Once more: refused, nothing changes.
  const int64_t generation = again.generation();
  EXPECT_EQ(exchange::add_files(again, files, options).rejected.size(), 4u);
  EXPECT_EQ(again.generation(), generation);
}

TEST_F(ExportTest, AStoppedExportIsResumedAndNoOtherOne) {
  const std::string folder = folder_ / "out";
  std::stop_source stop;
  Monitor monitor;
  monitor.stop = stop.get_token();
  monitor.progress = [&](const Progress& progress) {
    if (progress.done >= 2) stop.request_stop();
  };
  EXPECT_THROW(exchange::export_clips(database_, ids_, folder, {}, monitor), Interrupted);
  EXPECT_FALSE(std::filesystem::exists(folder + "/captions.jsonl"));
  EXPECT_NE(error_of([&] { exchange::export_clips(database_, ids_, folder, {}); }).find("--resume"),
            std::string::npos);
  exchange::ExportOptions other;
  other.resume = true;
  other.extension = ".bvh";
  EXPECT_NE(
      error_of([&] { exchange::export_clips(database_, ids_, folder, other); }).find("another"),
      std::string::npos);
  exchange::ExportOptions resume;
  resume.resume = true;
  exchange::export_clips(database_, ids_, folder, resume);
  exchange::export_clips(database_, ids_, folder, resume);  // of a finished one: nothing to do
  exchange::export_clips(database_, ids_, folder_ / "whole", {});
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "whole")) {
    const std::string name = entry.path().filename().string();
    EXPECT_EQ(read_file(folder + "/" + name), read_file(entry.path().string())) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(folder + "/export.json"));
}

}  // namespace
}  // namespace remomask
