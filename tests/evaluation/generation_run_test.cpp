#include "evaluation/generation_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>

#include "base/file.h"
#include "evaluation/generation_report.h"
#include "motion/canonical.h"
#include "tests/db/db_test_tools.h"
#include "tests/evaluation/evaluator_test_tools.h"

namespace remomask {
namespace {

constexpr int kLeftWrist = 20, kRightWrist = 21;
const std::vector<std::string> kContents = {"jump", "run", "walk"};

/// A standing body that says its content by how far its left wrist is lifted.
Motion motion_of(size_t content) {
  Motion motion = standing_body(8);
  for (int frame = 0; frame < motion.frames; ++frame) {
    motion.at(frame, kLeftWrist)[1] += 0.1f * static_cast<float>(content + 1);
  }
  return motion;
}

/// One axis for each content.
std::vector<float> vector_of(const Motion& motion) {
  const float lifted = motion.at(0, kLeftWrist)[1] - motion.at(0, kRightWrist)[1];
  std::vector<float> vector(kContents.size(), 0.f);
  vector[static_cast<size_t>(std::lround(lifted / 0.1f - 1))] = 1.f;
  return vector;
}

Motion generate_right(const evaluation::LabelPrompt& prompt) {
  const auto found = std::find(kContents.begin(), kContents.end(), prompt.content);
  return motion_of(static_cast<size_t>(found - kContents.begin()));
}

/// Train: 4 jump, 3 run, 2 walk; test: one of each, none of them in the gallery.
class GenerationProtocol : public ::testing::Test {
 protected:
  GenerationProtocol() : evaluator_(untrained_evaluator_stage(1)) {}

  void SetUp() override {
    database_.emplace(folder_ / "motions.sqlite", db::OpenMode::create);
    std::vector<db::ClipEmbedding> embeddings;
    const auto add = [&](size_t content, const std::string& split, const std::string& group) {
      db::Clip clip = named_clip("clip" + std::to_string(embeddings.size()));
      clip.labels = {{"content", kContents[content]}};
      clip.captions = {"a person shows " + kContents[content],
                       "a person lifts the left hand to " + kContents[content]};
      clip.split = split;
      clip.group = group;
      if (split == "test" && content == 1) clip.labels["unseen"] = "take";
      Motion motion = motion_of(content);
      motion.at(1, 0)[0] = 1e-4f * static_cast<float>(embeddings.size());
      db::ClipEmbedding embedding;
      embedding.clip_id = database_->add_clip(clip, motion);
      embedding.motion = vector_of(motion);
      embedding.text = embedding.motion;
      embedding.parts.assign(6, 0.f);
      embeddings.push_back(embedding);
    };
    for (size_t content = 0; content < 3; ++content) {
      for (size_t i = content; i < 4; ++i) {
        add(content, "train", "group" + kContents[content] + std::to_string(i));
      }
      add(content, "test", "group" + kContents[content] + std::to_string(content));
    }
    database_->store_embeddings("retriever", embeddings);
    index_.emplace(index::VectorIndex::build(*database_, "retriever"));
    judge_ = evaluation::retriever_judge(*index_, vector_of);
    options_.prompts = 6;
    options_.modality_prompts = 0;
    options_.gallery_splits = {"train"};
    options_.generator = "test";
    options_.results_path = folder_ / "results.jsonl";
  }

  evaluation::GenerationReport run(const evaluation::GenerateMotion& generate,
                                   const Monitor& monitor = {}) {
    const evaluation::JudgeGallery gallery(*database_, *judge_, options_.gallery_splits);
    const evaluation::GenerationRun done = evaluation::run_generation(
        *database_, gallery, *judge_, evaluator_, generate, options_, monitor);
    jobs_ = done.jobs;
    evaluation::GenerationReportOptions report;
    report.batch = 2;
    report.draws = 2;
    report.modality_picks = 2;
    return evaluation::report_generation(done, *database_, gallery, evaluator_, report);
  }

  TestFolder folder_;
  evaluation::Evaluator evaluator_;
  std::optional<db::Database> database_;
  std::optional<index::VectorIndex> index_;
  std::unique_ptr<evaluation::MotionJudge> judge_;
  evaluation::GenerationRunOptions options_;
  std::vector<evaluation::GenerationJob> jobs_;
};

TEST_F(GenerationProtocol, ARightGeneratorHasAccuracyOne) {
  const auto report = run(generate_right);
  const evaluation::GenerationSubset& all = report.subsets.at(0);
  EXPECT_EQ(all.name, "all");
  EXPECT_EQ(all.prompts, 6);
  EXPECT_EQ(all.generated.content.accuracy, 1);
  EXPECT_EQ(all.generated.content.standard_error, 0);
  EXPECT_EQ(all.real.content.accuracy, 1);
  // Prompts: a third each. Gallery: 4, 3 and 2 of 9.
  EXPECT_NEAR(all.chance, 1. / 3, 1e-12);
  EXPECT_EQ(report.contents.at("run").motions, 2);
  EXPECT_EQ(all.generated.physical.motions, 6);
  EXPECT_EQ(report.protocol.at("gallery_clips"), 9);
  EXPECT_EQ(nlohmann::json(report).at("contents").at("walk").at("nearest").at("walk"), 2);
  // All but the frame that tells real clips apart is equal.
  EXPECT_LT(all.generated.captions.fid.mean, 0.01);
  EXPECT_EQ(all.generated.captions.motions, 6);
  EXPECT_TRUE(std::isnan(report.multimodality.mean));
}

TEST_F(GenerationProtocol, CountsWhatAGeneratorShowsInstead) {
  const auto report = run([](const evaluation::LabelPrompt&) { return motion_of(0); });
  const evaluation::GenerationSubset& all = report.subsets.at(0);
  EXPECT_NEAR(all.generated.content.accuracy, 1. / 3, 1e-12);
  EXPECT_NEAR(all.generated.content.standard_error, std::sqrt(1. / 3 * 2 / 3 / 6), 1e-12);
  EXPECT_EQ(report.contents.at("jump").right, 2);
  EXPECT_EQ(report.contents.at("walk").right, 0);
  EXPECT_EQ(report.contents.at("walk").nearest.at("jump"), 2);
  // One motion for everything is chance: one half in batches of two.
  EXPECT_NEAR(all.generated.captions.r_precision[0].mean, 0.5, 1e-9);
  EXPECT_EQ(all.generated.captions.diversity.mean, 0);
}

TEST_F(GenerationProtocol, SubsetsByUnseenAndRarity) {
  const auto report = run(generate_right);
  ASSERT_EQ(report.subsets.size(), 3u);  // there is no "pair"
  EXPECT_EQ(report.subsets[1].name, "take");
  EXPECT_EQ(report.subsets[1].prompts, 2);
  EXPECT_NEAR(report.subsets[1].chance, 3. / 9, 1e-12);
  EXPECT_EQ(report.subsets[2].name, "rare");  // 4 training clips at most
  EXPECT_EQ(report.subsets[2].prompts, 6);
}

TEST_F(GenerationProtocol, CountsSides) {
  const auto lift = [](const evaluation::LabelPrompt& prompt) {
    Motion motion = generate_right(prompt);
    const int wrist = prompt.content == "walk" ? kRightWrist : kLeftWrist;
    for (int frame = 2; frame < motion.frames; ++frame) motion.at(frame, wrist)[2] += 0.2f;
    return motion;
  };
  const evaluation::SideCounts sides = run(lift).subsets.at(0).generated.sides;
  EXPECT_EQ(sides.hands.asked, 3);  // every second caption asks for the left hand
  EXPECT_EQ(sides.hands.right, 2);
  EXPECT_EQ(sides.turns.asked, 0);
}

TEST_F(GenerationProtocol, BrokenMotionsAreWrong) {
  const auto report = run([](const evaluation::LabelPrompt& prompt) {
    Motion motion = generate_right(prompt);
    if (prompt.content == "run") motion.at(2, 2)[0] = std::numeric_limits<float>::infinity();
    return motion;
  });
  const evaluation::MotionFigures& figures = report.subsets.at(0).generated;
  EXPECT_NEAR(figures.content.accuracy, 2. / 3, 1e-12);
  EXPECT_EQ(figures.physical.not_finite, 2);
  EXPECT_EQ(figures.captions.motions, 4);
  EXPECT_TRUE(std::isfinite(figures.captions.fid.mean));
  EXPECT_TRUE(report.contents.at("run").nearest.empty());
}

TEST_F(GenerationProtocol, CanLeaveTheOwnGroupOut) {
  const evaluation::JudgeGallery gallery(*database_, *judge_, {"train"});
  evaluation::LabelPrompt prompt;
  prompt.group = "groupjump0";
  prompt.content = "jump";
  EXPECT_EQ(gallery.judge(prompt, motion_of(0), evaluator_, false).nearest_clip, "clip0");
  EXPECT_EQ(gallery.judge(prompt, motion_of(0), evaluator_, true).nearest_clip, "clip1");
}

TEST_F(GenerationProtocol, RepeatsAndModalityHaveSeedsOfTheirOwn) {
  options_.repeats = 2;
  options_.modality_prompts = 3;
  options_.modality_repeats = 4;
  std::set<uint64_t> seeds;
  const auto report = run([&](const evaluation::LabelPrompt& prompt) {
    seeds.insert(prompt.seed);
    return generate_right(prompt);
  });
  EXPECT_EQ(jobs_.size(), 2u * 6 + 3 * 4);
  EXPECT_EQ(seeds.size(), jobs_.size());
  EXPECT_EQ(report.subsets.at(0).generated.content.motions, 12);
  EXPECT_EQ(report.subsets.at(0).real.content.motions, 6);
  EXPECT_EQ(report.contents.at("run").motions, 4);
  EXPECT_EQ(report.multimodality.mean, 0);
}

TEST_F(GenerationProtocol, GoesOnWhereItWasStopped) {
  const auto whole = run(generate_right);
  const std::string results = read_file(options_.results_path);
  std::filesystem::remove(options_.results_path);

  int generated = 0;
  std::stop_source stop;
  Monitor monitor;
  monitor.stop = stop.get_token();
  const auto count = [&](const evaluation::LabelPrompt& prompt) {
    if (++generated == 4) stop.request_stop();
    return generate_right(prompt);
  };
  EXPECT_THROW(run(count, monitor), Interrupted);
  EXPECT_EQ(generated, 4);
  // As if the program had been killed in the middle of a line.
  std::string partial = read_file(options_.results_path);
  partial.resize(partial.size() - 9);
  write_file_atomically(options_.results_path, partial);

  EXPECT_EQ(nlohmann::json(run(count)).dump(), nlohmann::json(whole).dump());
  EXPECT_EQ(generated, 7);
  EXPECT_EQ(read_file(options_.results_path), results);
  run(count);
  EXPECT_EQ(generated, 7) << "a finished run generates nothing";
}

TEST_F(GenerationProtocol, RefusesResultsOfAnotherProtocol) {
  run(generate_right);
  options_.generator = "other";
  EXPECT_NE(error_of([&] { run(generate_right); }).find("another generator"), std::string::npos);
  options_.generator = "test";
  const std::string results = read_file(options_.results_path);
  const size_t second = results.find('\n') + 1, third = results.find('\n', second) + 1;
  write_file_atomically(options_.results_path, results.substr(0, second) + results.substr(third));
  EXPECT_NE(error_of([&] { run(generate_right); }).find(":2: a result is missing"),
            std::string::npos);
  write_file_atomically(options_.results_path, results.substr(0, second) + "{\"a\": 1}\n");
  EXPECT_NE(error_of([&] { run(generate_right); }).find(":2: is no result"), std::string::npos);
  write_file_atomically(options_.results_path, "my thesis");
  EXPECT_NE(error_of([&] { run(generate_right); }).find("no file of results"), std::string::npos);
  EXPECT_EQ(read_file(options_.results_path), "my thesis");
}

TEST_F(GenerationProtocol, RefusesVectorsOfAnotherWidth) {
  judge_ =
      evaluation::retriever_judge(*index_, [](const Motion&) { return std::vector<float>{1.f}; });
  EXPECT_NE(error_of([&] { run(generate_right); }).find("1 numbers"), std::string::npos);
}

TEST_F(GenerationProtocol, TheEvaluatorJudgesInItsOwnSpace) {
  // Stored clips are canonical.
  const Motion canonical = motion::canonicalize(standing_body(8), humanml_skeleton());
  const int64_t asked = database_->add_clip(named_clip("standing"), canonical);
  const auto judge = evaluation::evaluator_judge(evaluator_, *database_);
  ASSERT_EQ(judge->clip_ids().size(), 13u);
  const auto vector = judge->embed(database_->motion(asked));
  const auto near = judge->nearest(vector, judge->clip_ids());
  ASSERT_TRUE(near.has_value());
  EXPECT_EQ(near->clip_id, asked);
  EXPECT_NEAR(near->distance, 0, 1e-3);
  const auto other = judge->nearest(vector, {judge->clip_ids()[0]});
  EXPECT_EQ(other->clip_id, judge->clip_ids()[0]);
  EXPECT_GT(other->distance, near->distance);
  EXPECT_FALSE(judge->nearest(vector, {}).has_value());
  EXPECT_EQ(judge->identity(), "evaluator " + evaluator_.hash());
}

}  // namespace
}  // namespace remomask
