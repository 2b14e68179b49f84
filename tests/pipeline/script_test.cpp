#include "pipeline/script.h"
#include "motion/vector.h"

#include <gtest/gtest.h>
#include <torch/types.h>

#include "pipeline/length_estimate.h"
#include "pipeline/motion_finish.h"
#include "remomask/error.h"
#include "tests/generator/tiny_model.h"

namespace remomask {
namespace {

TEST(ParseScript, LinesWithAndWithoutSeconds) {
  const auto lines = parse_script(
      "# a comment\n"
      "3  a person walks   # to the door\r\n"
      "\n"
      "  2.5\tsomeone waves with hand #2 up\n"
      "a man bows",
      "s.txt");
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].sentence, "a person walks");
  EXPECT_EQ(lines[0].seconds, 3);
  EXPECT_EQ(lines[0].line, 2);
  EXPECT_EQ(lines[1].sentence, "someone waves with hand");
  EXPECT_EQ(lines[1].seconds, 2.5);
  EXPECT_EQ(lines[2].sentence, "a man bows");
  EXPECT_FALSE(lines[2].seconds.has_value());
  EXPECT_EQ(lines[2].line, 5);
}

TEST(ParseScript, ErrorsSayFileAndLine) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      parse_script(text, "s.txt");
    } catch (const FileError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("walk\n0.5 run\n").find("s.txt:2: "), std::string::npos);
  EXPECT_NE(message("walk\n0.5 run\n").find("1 to 600"), std::string::npos);
  EXPECT_NE(message("1e9 run").find("s.txt:1: "), std::string::npos);
  EXPECT_NE(message("nan run").find("s.txt:1: "), std::string::npos);
  EXPECT_NE(message("4 \n").find("no sentence"), std::string::npos);
  EXPECT_NE(message("# nothing\n\n").find("s.txt: "), std::string::npos);
  for (const char* seconds : {"2,5", "3s", "2.5sec", "1.2.3"}) {
    const std::string text = message(std::string("walk\n") + seconds + " someone waves\n");
    EXPECT_NE(text.find("s.txt:2: "), std::string::npos) << seconds;
    EXPECT_NE(text.find("like 2.5"), std::string::npos) << seconds;
  }
}

TEST(ParseScript, FilesOfWindowsPrograms) {
  const auto lines = parse_script(
      "\xEF\xBB\xBF"
      "2 a person walks forward\r\n",
      "s.txt");
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].seconds, 2);
  EXPECT_EQ(lines[0].sentence, "a person walks forward");
  EXPECT_EQ(parse_script("2 a person walks\r1.5 someone waves\r", "s.txt").size(), 2u);
}

std::vector<pipeline::ScriptSegment> three_segments() {
  return {{"a person walks", {}, 2.1}, {"a man waves", {}, 1.55}, {"a person jumps", {}, 12.0}};
}

TEST(GenerateScript, LengthsAreExactAndTheSameAgain) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  pipeline::ScriptOptions options;
  options.generate.seed = 5;
  const pipeline::ScriptMotion made =
      pipeline::generate_script(generator, three_segments(), options);
  EXPECT_EQ(made.motion.frames, 42 + 31 + 240);
  ASSERT_EQ(made.segments.size(), 3u);
  EXPECT_EQ(made.segments[1].first, 42);
  EXPECT_EQ(made.segments[1].last, 73);
  EXPECT_EQ(made.tokens.size(0), (313 + 3) / 4);
  const pipeline::ScriptMotion again =
      pipeline::generate_script(generator, three_segments(), options);
  EXPECT_EQ(again.motion.positions, made.motion.positions);
  options.generate.seed = 6;
  EXPECT_FALSE(torch::equal(pipeline::generate_script(generator, three_segments(), options).tokens,
                            made.tokens));
  double worst = 0;
  const Skeleton& skeleton = humanml_skeleton();
  for (int t = 0; t < made.motion.frames; ++t) {
    for (int j = 1; j < 22; ++j) {
      const double length =
          (joint_position(made.motion, t, j) - joint_position(made.motion, t, skeleton.parents[j]))
              .norm();
      worst = std::max(worst, std::abs(length - skeleton.bone_lengths[j]));
    }
  }
  EXPECT_LT(worst, 1e-4);
}

TEST(GenerateScript, OnlyTheSeamOfTheSegmentBeforeChanges) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  const auto tokens = [&](size_t count) {
    auto segments = three_segments();
    segments.resize(count);
    return pipeline::generate_script(generator, segments).tokens;
  };
  // 2.1 s are 42 frames: the seam lies at token 11 of the whole, alone they end in token 11.
  const at::Tensor one = tokens(1), two = tokens(2);
  EXPECT_TRUE(torch::equal(one.slice(0, 0, 9), two.slice(0, 0, 9)));
  EXPECT_FALSE(torch::equal(two.slice(0, 11), tokens(3).slice(0, 11, two.size(0))));
}

TEST(GenerateScript, OneShortSentenceIsAPlainGeneration) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  GenerateOptions plain;
  plain.seconds = 2.0;
  plain.seed = 8;
  pipeline::ScriptOptions options;
  options.generate.seed = 8;
  EXPECT_TRUE(
      torch::equal(pipeline::generate_script(generator, {{"a man waves", {}, 2.0}}, options).tokens,
                   generator.generate("a man waves", {}, plain).tokens));
  EXPECT_THROW(pipeline::generate_script(generator, {}), Error);
}

TEST(GenerateScript, TheJudgeChoosesAmongCandidates) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  pipeline::ScriptOptions options;
  const pipeline::ScriptMotion plain =
      pipeline::generate_script(generator, three_segments(), options);
  options.candidates = 3;
  int judged = 0;
  options.judge = [&](const std::string&, const Motion& piece, int seam) {
    EXPECT_LT(seam, piece.frames);
    return judged++ % 3 == 1 ? 1.0 : 0.5;  // the second of each
  };
  const pipeline::ScriptMotion chosen =
      pipeline::generate_script(generator, three_segments(), options);
  EXPECT_EQ(judged, 9);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(chosen.segments[i].score, 1);
    EXPECT_NE(chosen.segments[i].seed, plain.segments[i].seed);
  }
  EXPECT_FALSE(torch::equal(chosen.tokens, plain.tokens));
}

TEST(SmoothOverTime, KeepsLinesAndEndsAndWidensSteps) {
  Motion motion(21, 22);
  for (int t = 0; t < 21; ++t) {
    set_joint_position(motion, t, 3, Vec3(0.1 * t, t < 10 ? 0 : 1, 0));
  }
  pipeline::smooth_over_time(motion, 1);
  for (int t = 0; t < 21; ++t) EXPECT_NEAR(motion.at(t, 3)[0], 0.1 * t, 1e-6);
  // Half of the weight at the centre: 0.3990 of a Gaussian cut at three sigma.
  EXPECT_NEAR(motion.at(10, 3)[1], 0.5 + 0.3990 / 2, 1e-3);
  EXPECT_NEAR(motion.at(9, 3)[1], 0.5 - 0.3990 / 2, 1e-3);
  EXPECT_EQ(motion.at(0, 3)[1], 0);
  EXPECT_EQ(motion.at(20, 3)[1], 1);
}

TEST(LiftToFloorSmoothly, RaisesTheSurroundingsOfADeepStep) {
  Motion motion(100, 22);
  for (int t = 0; t < 100; ++t) {
    for (int j = 0; j < 22; ++j) motion.at(t, j)[1] = 1;
  }
  motion.at(50, 10)[1] = -0.1f;
  EXPECT_NEAR(pipeline::lift_to_floor_smoothly(motion, humanml_skeleton(), 5), 0.1, 1e-6);
  EXPECT_NEAR(motion.at(50, 10)[1], 0, 1e-6);
  EXPECT_NEAR(motion.at(50, 0)[1], 1.1, 1e-6);
  EXPECT_GT(motion.at(45, 0)[1], 1.0f);
  EXPECT_LT(motion.at(45, 0)[1], 1.1f);
  EXPECT_EQ(motion.at(39, 0)[1], 1.0f);
}

TEST(LengthDistribution, FollowsTheNearest) {
  // The second counts exp(-0.2 / 0.1) = 0.135 of the first.
  const auto distribution = pipeline::length_distribution({{0.9, 80}, {0.7, 120}, {0.9, 0}});
  ASSERT_EQ(distribution.size(), 50u);
  const double whole = 1 + std::exp(-2.0);
  EXPECT_NEAR(distribution[20], 3. / 9 / whole, 1e-9);
  EXPECT_NEAR(distribution[22], 1. / 9 / whole, 1e-9);
  EXPECT_NEAR(distribution[30], 3. / 9 * std::exp(-2.0) / whole, 1e-9);
  EXPECT_EQ(distribution[0], 0);
  EXPECT_NEAR(pipeline::estimate_seconds(distribution, LengthRule::likely, 0), 4.0, 1e-9);
  int drawn_long = 0;
  for (uint64_t seed = 0; seed < 2000; ++seed) {
    const double seconds = pipeline::estimate_seconds(distribution, LengthRule::sample, seed);
    EXPECT_TRUE((seconds > 3.5 && seconds < 4.5) || (seconds > 5.5 && seconds < 6.5)) << seconds;
    drawn_long += seconds > 5;
  }
  EXPECT_NEAR(drawn_long / 2000., std::exp(-2.0) / whole, 0.025);
}

TEST(LengthDistribution, KeepsToPossibleLengths) {
  const auto extremes = pipeline::length_distribution({{0.5, 6}, {0.5, 900}});
  for (size_t i = 0; i < 5; ++i) EXPECT_EQ(extremes[i], 0);
  EXPECT_GT(extremes[5], 0);
  EXPECT_GT(extremes[49], 0);
  const auto nothing = pipeline::length_distribution({});
  EXPECT_NEAR(nothing[5], 1. / 45, 1e-12);
  EXPECT_NEAR(nothing[49], 1. / 45, 1e-12);
}

}  // namespace
}  // namespace remomask
