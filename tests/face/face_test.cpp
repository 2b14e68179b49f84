// The library's face with the shipped model and database.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/file.h"
#include "remomask/error.h"
#include "remomask/library.h"
#include "remomask/motion_file.h"
#include "remomask/rotations.h"
#include "remomask/text_to_motion.h"
#include "tests/tools/program_runner.h"

namespace remomask {
namespace {

constexpr const char* kSentence = "a person walks forward, then waves with the right hand";

OpenOptions with_threads(int threads) {
  OpenOptions options;
  options.threads = threads;
  return options;
}

const TextToMotion& face() {
  static const TextToMotion face(shipped_model(), shipped_database(), with_threads(2));
  return face;
}

GenerateOptions short_motion(uint64_t seed) {
  GenerateOptions options;
  options.seconds = 2;
  options.seed = seed;
  return options;
}

TEST(Face, ProgramAndLibraryWriteTheSameFiles) {
  const TestFolder folder;
  const ProgramResult ran = run_program(
      {"generate", kSentence, "--seed", "7", "--influence", "-o", folder / "program.npy"});
  ASSERT_EQ(ran.exit_code, 0) << ran.errors;
  GenerateOptions options;
  options.seed = 7;
  options.influence = true;
  const GeneratedMotion made = face().generate(kSentence, options);
  save_motion(folder / "library.npy", made);
  EXPECT_EQ(read_file(folder / "library.npy"), read_file(folder / "program.npy"));
  EXPECT_EQ(read_file(folder / "library.npy.json"), read_file(folder / "program.npy.json"));
}

TEST(Face, ProgramAndLibraryEditTheSameWay) {
  const TestFolder folder;
  save_motion(folder / "walk.npy",
              face().generate("a person walks forward", short_motion(1)).motion);
  const ProgramResult ran =
      run_program({"edit", folder / "walk.npy", "-o", folder / "program.npy", "--prompt",
                   "someone waves", "--span", "0.5-1.5", "--parts", "arms", "--seed", "4"});
  ASSERT_EQ(ran.exit_code, 0) << ran.errors;
  MotionFileOptions as_it_is;
  as_it_is.canonical = false;
  const Motion original = load_motion(folder / "walk.npy", as_it_is).motion;
  EditOptions options;
  options.seed = 4;
  const EditSpan arms{10, 30, {"arms"}};
  save_motion(folder / "library.npy",
              face().edit(original, std::span(&arms, 1), "someone waves", options).motion);
  EXPECT_EQ(read_file(folder / "library.npy"), read_file(folder / "program.npy"));
}

TEST(Face, ThreadsDoNotChangeAMotion) {
  const TextToMotion single(shipped_model(), shipped_database(), with_threads(1));
  for (uint64_t seed = 1; seed <= 3; ++seed) {
    const GeneratedMotion a = single.generate(kSentence, short_motion(seed));
    const GeneratedMotion b = face().generate(kSentence, short_motion(seed));
    EXPECT_EQ(a.motion.positions, b.motion.positions) << "seed " << seed;
  }
  const std::vector<ScriptLine> lines = {{"a person walks forward", 2.0, 0},
                                         {"someone waves with the left hand", 2.0, 0}};
  EXPECT_EQ(single.script(lines).motion.positions, face().script(lines).motion.positions);
}

TEST(Face, SeveralThreadsMayCallItAtOnce) {
  std::vector<Motion> alone, beside(3);
  for (uint64_t seed = 0; seed < 3; ++seed) {
    alone.push_back(face().generate(kSentence, short_motion(seed)).motion);
  }
  SearchQuery query;
  query.text = "someone walks slowly";
  const SearchAnswer found = face().search(query);
  {
    std::vector<std::jthread> callers;
    for (uint64_t seed = 0; seed < 3; ++seed) {
      callers.emplace_back(
          [&, seed] { beside[seed] = face().generate(kSentence, short_motion(seed)).motion; });
    }
    callers.emplace_back([&] {
      for (int i = 0; i < 5; ++i) {
        const SearchAnswer again = face().search(query);
        ASSERT_EQ(again.hits.size(), found.hits.size());
        EXPECT_EQ(again.hits.front().clip.name, found.hits.front().clip.name);
      }
    });
  }
  for (size_t i = 0; i < beside.size(); ++i) {
    EXPECT_EQ(beside[i].positions, alone[i].positions) << "seed " << i;
  }
}

TEST(Face, StopsInsideOfOneGeneration) {
  std::stop_source source;
  Monitor monitor;
  monitor.stop = source.get_token();
  const std::jthread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    source.request_stop();
  });
  face();
  GenerateOptions minute;
  minute.seconds = 60;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THROW(face().generate(kSentence, minute, monitor), Interrupted);
  // A motion of a minute takes many times as long; one pass takes a tenth of a second.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(3));
}

TEST(Face, ReportsProgressOfLongMotions) {
  std::vector<double> done;
  Monitor monitor;
  monitor.progress = [&](const Progress& progress) { done.push_back(progress.done); };
  GenerateOptions options;
  options.seconds = 14;
  face().generate(kSentence, options, monitor);
  ASSERT_GE(done.size(), 2u);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
}

TEST(Face, EvidenceSaysWhatWasReadAndFollowed) {
  const GeneratedMotion made = face().generate(kSentence, short_motion(7));
  const std::vector<Evidence> retrieved = face().retrieve(kSentence, short_motion(7));
  ASSERT_FALSE(made.evidence.empty());
  ASSERT_EQ(retrieved.size(), made.evidence.size());
  EXPECT_EQ(made.evidence.front().use, EvidenceUse::read);
  EXPECT_FALSE(made.evidence.front().hit.clip.captions.empty());
  int followed = 0;
  for (size_t i = 0; i < retrieved.size(); ++i) {
    EXPECT_EQ(retrieved[i].hit.clip.id, made.evidence[i].hit.clip.id);
    EXPECT_EQ(retrieved[i].use, made.evidence[i].use);
    EXPECT_EQ(made.evidence[i].use == EvidenceUse::read, made.evidence[i].trust > 0);
    followed += made.evidence[i].followed_share > 0;
  }
  EXPECT_EQ(followed, 1);
  GenerateOptions alone = short_motion(7);
  alone.use_retrieval = false;
  EXPECT_TRUE(face().generate(kSentence, alone).evidence.empty());
}

TEST(Face, SlidingFeetAreLeftAloneWhereAskedForInEdits) {
  const Motion walk = face().generate("a person walks forward", short_motion(3)).motion;
  const EditSpan span{8, 36, {}};
  EditOptions held, free;
  held.seed = free.seed = 2;
  free.held_feet = false;
  const std::span spans(&span, 1);
  EXPECT_NE(face().edit(walk, spans, "a person runs", held).motion.positions,
            face().edit(walk, spans, "a person runs", free).motion.positions);
}

TEST(Face, NetworksMayBeFreedAfterEveryCall) {
  OpenOptions options = with_threads(2);
  options.low_memory = true;
  const TextToMotion frugal(shipped_model(), shipped_database(), options);
  EXPECT_EQ(frugal.generate(kSentence, short_motion(5)).motion.positions,
            face().generate(kSentence, short_motion(5)).motion.positions);
}

TEST(Face, TheSidecarIsTyped) {
  const TestFolder folder;
  GenerateOptions options = short_motion(9);
  options.best_of = 2;
  save_motion(folder / "made.bvh", face().generate(kSentence, options));
  const auto sidecar = nlohmann::json::parse(read_file(folder / "made.bvh.json"));
  EXPECT_EQ(sidecar.at("schema"), "remomask.motion/1");
  EXPECT_EQ(sidecar.at("seed"), "9");
  EXPECT_EQ(sidecar.at("frames"), 40);
  const auto& segment = sidecar.at("segments").at(0);
  EXPECT_EQ(segment.at("sentence"), kSentence);
  EXPECT_TRUE(segment.at("evidence").at(0).at("similarity").is_number());
  EXPECT_TRUE(segment.at("evidence").at(0).at("licence").is_string());
  ASSERT_EQ(segment.at("candidates").size(), 2u);
  EXPECT_TRUE(segment.at("candidates").at(0).at("seed").is_string());
  EXPECT_EQ(segment.at("candidates").at(0).at("seed"), segment.at("candidate_seed"));
}

TEST(Face, ClipsAddedMeanwhileAreFound) {
  const TestFolder folder;
  const std::string database = folder / "mine.sqlite";
  std::filesystem::copy_file(shipped_database(), database);
  std::filesystem::copy_file(shipped_database() + ".index", database + ".index");
  const TextToMotion open(shipped_model(), database, with_threads(2));
  SearchQuery query;
  query.text = "a person hops on the left foot";
  const auto before = open.search(query).candidates;
  save_motion(folder / "hop.npy", face().generate("a person jumps", short_motion(1)).motion);
  const std::vector<std::string> files = {folder / "hop.npy", folder / "absent.npy"};
  AddOptions options;
  options.captions = {query.text};
  const AddReport added = add_motion_files(database, files, options);
  ASSERT_EQ(added.clips, std::vector<std::string>{"hop"});
  ASSERT_EQ(added.rejected.size(), 1u);
  EXPECT_EQ(index_database(database, shipped_model()).embedded, 1);
  const SearchAnswer answer = open.search(query);
  EXPECT_EQ(answer.candidates, before + 1);
}

TEST(Face, NeedsNoIndexWithoutRetrieval) {
  const TestFolder folder;
  const std::string database = folder / "unindexed.sqlite";
  std::filesystem::copy_file(shipped_database(), database);
  EXPECT_THROW(TextToMotion(shipped_model(), database), Error);
  OpenOptions open = with_threads(2);
  open.retrieval = false;
  const TextToMotion unindexed(shipped_model(), database, open);
  GenerateOptions options = short_motion(6);
  EXPECT_THROW(unindexed.generate(kSentence, options), Error);
  options.use_retrieval = false;
  EXPECT_EQ(unindexed.generate(kSentence, options).motion.positions,
            face().generate(kSentence, options).motion.positions);
  const ProgramResult ran = run_program({"generate", kSentence, "--no-retrieval", "--db", database,
                                         "--seconds", "2", "-o", folder / "alone.npy"});
  EXPECT_EQ(ran.exit_code, 0) << ran.errors;
}

TEST(Face, RefusesWhatItCannotDo) {
  EXPECT_THROW(face().generate(""), Error);
  GenerateOptions none;
  none.best_of = 0;
  EXPECT_THROW(face().generate(kSentence, none), Error);
  EXPECT_THROW(face().script({}), Error);
  EXPECT_THROW(TextToMotion(shipped_model(), "absent.sqlite"), Error);
  EXPECT_THROW(TextToMotion("absent.safetensors", shipped_database()), Error);
}

TEST(Face, RotationsGiveTheJointsBack) {
  const Motion motion = face().generate(kSentence, short_motion(1)).motion;
  const JointRotations pose = solve_rotations(motion);
  ASSERT_EQ(pose.frames, motion.frames);
  ASSERT_EQ(pose.rotations.size(), static_cast<size_t>(motion.frames * motion.joints));
  for (const Quaternion& q : pose.rotations) {
    EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-5);
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(pose.root[5][static_cast<size_t>(axis)], motion.at(5, 0)[axis], 0.02);
  }
}

}  // namespace
}  // namespace remomask
