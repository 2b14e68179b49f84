#include "evaluation/generation_labels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "base/file.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

const std::vector<std::string> kContents = {"jump", "run", "walk"};

/// A motion that says its content by the height of the root in frame 0, and its
/// vector: one axis for each content.
Motion motion_of(size_t content) {
  Motion motion(4, 22);
  motion.at(0, 0)[1] = 1.f + static_cast<float>(content);
  return motion;
}

std::vector<float> vector_of(const Motion& motion) {
  std::vector<float> vector(kContents.size(), 0.f);
  vector[static_cast<size_t>(motion.at(0, 0)[1] - 1.f)] = 1.f;
  return vector;
}

Motion generate_right(const LabelPrompt& prompt) {
  const auto found = std::find(kContents.begin(), kContents.end(), prompt.content);
  return motion_of(static_cast<size_t>(found - kContents.begin()));
}

/// Train: 4 jump, 3 run, 2 walk; test: one of each, none of them in the gallery.
class LabelProtocol : public ::testing::Test {
 protected:
  void SetUp() override {
    database_.emplace(folder_ / "motions.sqlite", OpenMode::create);
    std::vector<ClipEmbedding> embeddings;
    const auto add = [&](size_t content, const std::string& split, const std::string& group) {
      const auto number = static_cast<float>(embeddings.size());
      Clip clip = named_clip("clip" + std::to_string(embeddings.size()));
      clip.labels = {{"content", kContents[content]}};
      clip.split = split;
      clip.group = group;
      Motion motion = motion_of(content);
      motion.at(1, 0)[0] = number;
      ClipEmbedding embedding;
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
      add(content, "test", "group" + kContents[content] + "0");
    }
    database_->store_embeddings("retriever", embeddings);
    index_.emplace(VectorIndex::build(*database_, "retriever"));
    options_.prompts = 6;
    options_.gallery_splits = {"train"};
    options_.generator = "test";
    options_.results_path = folder_ / "results.jsonl";
  }

  GenerationLabelReport run(const GenerateMotion& generate, const Monitor& monitor = {}) {
    return measure_generation_labels(*database_, *index_, generate, vector_of, options_, monitor);
  }

  TestFolder folder_;
  std::optional<Database> database_;
  std::optional<VectorIndex> index_;
  GenerationLabelOptions options_;
};

TEST_F(LabelProtocol, ARightGeneratorHasAccuracyOne) {
  const auto report = run(generate_right);
  EXPECT_EQ(report.prompts, 6);
  EXPECT_EQ(report.accuracy, 1);
  EXPECT_EQ(report.standard_error, 0);
  // Prompts: a third each. Gallery: 4, 3 and 2 of 9.
  EXPECT_NEAR(report.chance, 1. / 3, 1e-12);
  EXPECT_NEAR(report.gallery_chance, (16. + 9 + 4) / 81, 1e-12);
  EXPECT_EQ(report.labels.at("run").prompts, 2);
  EXPECT_EQ(report.physical.motions, 6);
  EXPECT_EQ(report.protocol.at("gallery_clips"), 9);
  EXPECT_EQ(nlohmann::json(report).at("labels").at("walk").at("nearest").at("walk"), 2);
}

TEST_F(LabelProtocol, CountsWhatAGeneratorShowsInstead) {
  const auto report = run([](const LabelPrompt&) { return motion_of(0); });
  EXPECT_NEAR(report.accuracy, 1. / 3, 1e-12);
  EXPECT_NEAR(report.standard_error, std::sqrt(1. / 3 * 2 / 3 / 6), 1e-12);
  EXPECT_EQ(report.labels.at("jump").right, 2);
  EXPECT_EQ(report.labels.at("walk").right, 0);
  EXPECT_EQ(report.labels.at("walk").nearest.at("jump"), 2);
}

TEST_F(LabelProtocol, BrokenMotionsAreWrong) {
  const auto report = run([](const LabelPrompt& prompt) {
    Motion motion = generate_right(prompt);
    if (prompt.content == "run") motion.at(2, 2)[0] = std::numeric_limits<float>::infinity();
    return motion;
  });
  EXPECT_NEAR(report.accuracy, 2. / 3, 1e-12);
  EXPECT_EQ(report.physical.not_finite, 2);
  EXPECT_TRUE(report.labels.at("run").nearest.empty());
}

TEST_F(LabelProtocol, CanLeaveTheOwnGroupOut) {
  // Every real test clip lies in a group with one clip of its content in train.
  options_.exclude_own_group = true;
  run(generate_right);
  const std::string results = read_file(options_.results_path);
  EXPECT_EQ(results.find("\"nearest_clip\":\"clip0\""), std::string::npos);
  EXPECT_NE(results.find("\"nearest_clip\":\"clip1\""), std::string::npos);
}

TEST_F(LabelProtocol, GoesOnWhereItWasStopped) {
  const auto whole = run(generate_right);
  const std::string results = read_file(options_.results_path);
  std::filesystem::remove(options_.results_path);

  int generated = 0;
  std::stop_source stop;
  Monitor monitor;
  monitor.stop = stop.get_token();
  const auto count = [&](const LabelPrompt& prompt) {
    if (++generated == 4) stop.request_stop();
    return generate_right(prompt);
  };
  EXPECT_THROW(run(count, monitor), Interrupted);
  EXPECT_EQ(generated, 4);
  // As if the program had been killed in the middle of a line.
  std::string partial = read_file(options_.results_path);
  partial.resize(partial.size() - 9);
  write_file_atomically(options_.results_path, partial);

  EXPECT_EQ(nlohmann::json(run(count)), nlohmann::json(whole));
  EXPECT_EQ(generated, 7);
  EXPECT_EQ(read_file(options_.results_path), results);
  run(count);
  EXPECT_EQ(generated, 7) << "a finished run generates nothing";
}

TEST_F(LabelProtocol, RefusesResultsOfAnotherProtocol) {
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

TEST_F(LabelProtocol, RefusesAStaleIndexAndWrongWidths) {
  EXPECT_NE(error_of([&] {
              measure_generation_labels(
                  *database_, *index_, generate_right,
                  [](const Motion&) { return std::vector<float>{1.f}; }, options_);
            }).find("1 numbers"),
            std::string::npos);
  Clip clip = named_clip("later");
  database_->add_clip(clip, Motion(5, 22));
  EXPECT_NE(error_of([&] { run(generate_right); }).find("has changed"), std::string::npos);
}

}  // namespace
}  // namespace remomask
