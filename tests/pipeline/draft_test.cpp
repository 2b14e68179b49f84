#include "pipeline/draft.h"
#include "motion/vector.h"

#include <gtest/gtest.h>
#include <torch/types.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "motion/features.h"
#include "remomask/error.h"
#include "remomask/skeleton.h"
#include "tests/generator/tiny_model.h"
#include "tests/pipeline/pipeline_test_tools.h"
#include "tokenizer/tokenizer_network.h"

namespace remomask {
namespace {

TEST(Draft, PrefersHitsOfLikeLength) {
  // 0.70 exp(-0.1 x 0.8) = 0.646 against 0.69.
  EXPECT_EQ(pipeline::choose_draft({{0.70, 20}, {0.69, 100}, {0.5, 100}}, 100, 1), 1u);
  std::set<size_t> chosen;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    chosen.insert(*pipeline::choose_draft({{0.70, 100}, {0.69, 100}, {0.6, 100}}, 100, seed));
  }
  EXPECT_EQ(chosen, (std::set<size_t>{0, 1})) << "equally good hits are drawn, worse ones never";
  EXPECT_FALSE(pipeline::choose_draft({{0.9, 0}, {0.9, 7}}, 100, 1)) << "hits without poses";
  EXPECT_FALSE(pipeline::choose_draft({}, 100, 1));
}

/// The root goes 1 cm a frame, from frame 30 to 60 ten times as fast.
Motion sprint(int frames) {
  Motion motion(frames, 22);
  double place = 0;
  for (int t = 0; t < frames; ++t) {
    place += t > 30 && t <= 60 ? 0.1 : 0.01;
    for (int joint = 0; joint < 22; ++joint) set_joint_position(motion, t, joint, {place, 1, 0});
  }
  return motion;
}

TEST(Draft, FitsTheLength) {
  const Motion motion = sprint(100);
  const Motion near = pipeline::fit_length(motion, 80);
  ASSERT_EQ(near.frames, 80);
  EXPECT_EQ(joint_position(near, 0, 0).x(), joint_position(motion, 0, 0).x());
  EXPECT_NEAR(joint_position(near, 79, 0).x(), joint_position(motion, 99, 0).x(), 1e-6);
  // Frame 40 of 80 lies at 40 x 99 / 79 = 50.127.
  EXPECT_NEAR(
      joint_position(near, 40, 0).x(),
      0.873418 * joint_position(motion, 50, 0).x() + 0.126582 * joint_position(motion, 51, 0).x(),
      1e-5);
  const Motion part = pipeline::fit_length(motion, 31);
  ASSERT_EQ(part.frames, 31);
  EXPECT_EQ(joint_position(part, 0, 0).x(), joint_position(motion, 30, 0).x())
      << "the liveliest stretch";
  EXPECT_EQ(pipeline::fit_length(motion, 300).positions, motion.positions)
      << "the rest is left to others";
}

TEST(Draft, FollowedFramesAreSpreadEvenly) {
  for (const double share : {0.0, 0.2, 0.5, 0.8, 1.0}) {
    const std::vector<bool> followed = pipeline::followed_frames(40, share, 7);
    EXPECT_EQ(std::count(followed.begin(), followed.end(), true), std::lround(40 * share));
    // Three-distance theorem: the gaps differ little. No run of either kind is long.
    int run = 1, longest = 1;
    for (size_t t = 1; t < followed.size(); ++t) {
      run = followed[t] == followed[t - 1] ? run + 1 : 1;
      longest = std::max(longest, run);
    }
    const std::map<double, int> most = {{0, 40}, {0.2, 7}, {0.5, 3}, {0.8, 7}, {1, 40}};
    EXPECT_LE(longest, most.at(share)) << share;
  }
  const auto less = pipeline::followed_frames(40, 0.3, 7),
             more = pipeline::followed_frames(40, 0.6, 7);
  for (size_t t = 0; t < less.size(); ++t) EXPECT_TRUE(!less[t] || more[t]) << t;
  EXPECT_NE(pipeline::followed_frames(40, 0.5, 7), pipeline::followed_frames(40, 0.5, 8));
}

std::vector<pipeline::RetrievedMotion> posed_hit() {
  std::vector<pipeline::RetrievedMotion> hits = two_hits();
  hits.resize(1);
  hits[0].poses = motion::recover_motion(swinging_clips({40})[0].features, humanml_skeleton());
  return hits;
}

at::Tensor hit_codes(const pipeline::Generator& generator, const Motion& poses) {
  const motion::FeatureMode mode =
      motion::parse_feature_mode(generator.tokenizer().config().feature_mode);
  return generator.tokenizer().encode(
      motion::extract_features_all_frames(poses, humanml_skeleton(), mode));
}

GenerateOptions following(double share) {
  GenerateOptions options;
  options.seconds = 2;
  options.seed = 3;
  options.follow = share;
  return options;
}

TEST(Draft, AMotionKeepsTheCodesThatItFollows) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  const auto hits = posed_hit();
  const at::Tensor codes = hit_codes(generator, *hits[0].poses);
  const pipeline::Generated half = generator.generate("a person walks", hits, following(0.5));
  ASSERT_TRUE(half.followed);
  EXPECT_EQ(half.followed->clip_id, hits[0].clip_id);
  EXPECT_EQ(half.followed->share, 0.5);
  const std::vector<bool> followed = pipeline::followed_frames(10, 0.5, 3);
  for (int64_t t = 0; t < 10; ++t) {
    EXPECT_TRUE(!followed[static_cast<size_t>(t)] || half.tokens[t].equal(codes[t])) << t;
  }
  const pipeline::Generated whole = generator.generate("a person walks", hits, following(1));
  EXPECT_TRUE(whole.tokens.equal(codes));
  const pipeline::Generated none = generator.generate("a person walks", hits, following(0));
  EXPECT_FALSE(none.followed);
  EXPECT_FALSE(none.tokens.equal(half.tokens));
}

TEST(Draft, ADraftShorterThanTheMotionIsItsBeginning) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  const auto hits = posed_hit();
  GenerateOptions options = following(1);
  options.seconds = 14;  // several windows, the draft in the first
  const pipeline::Generated made = generator.generate("a person walks", hits, options);
  ASSERT_EQ(made.tokens.size(0), 70);
  EXPECT_TRUE(made.tokens.slice(0, 0, 10).equal(hit_codes(generator, *hits[0].poses)));
}

TEST(Draft, KnownFramesAndTheirSeamsStay) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  const auto hits = posed_hit();
  pipeline::TokenCanvas canvas = generator.canvas(10);
  canvas.tokens.slice(0, 0, 4).fill_(5);
  canvas.known.slice(0, 0, 4).fill_(true);
  const at::Tensor drafted =
      hit_codes(generator, pipeline::fit_length(*hits[0].poses, 24));  // of token frames 4 to 10
  generator.fill(canvas, 4, 10, "a person walks", hits, following(1));
  EXPECT_TRUE(canvas.tokens.slice(0, 0, 4).eq(5).all().item<bool>());
  EXPECT_TRUE(canvas.tokens.slice(0, 6, 10).equal(drafted.slice(0, 2, 6)))
      << "what is two frames away from the seam follows";
}

nlohmann::json toy_gate() {
  return {{"motion", {{"none", 0.6}, {"all", 0.8}}}, {"caption", {{"none", 0.9}, {"all", 0.95}}}};
}

TEST(Draft, TheGateDecidesHowFarAHitIsFollowed) {
  auto stages = tiny_model().stages;
  stages.at("masked").config["evidence_gate"] = toy_gate();
  const pipeline::Generator generator(stages, tiny_words());
  auto hits = posed_hit();
  const auto share = [&](double similarity) {
    hits[0].similarity = similarity;
    const pipeline::Generated made = generator.generate("a person walks", hits, following(0.8));
    return made.followed ? made.followed->share : 0.0;
  };
  EXPECT_EQ(share(0.5), 0);
  EXPECT_NEAR(share(0.7), 0.4, 1e-9);
  EXPECT_EQ(share(0.9), 0.8);
  hits[0].caption_similarity = 0.95;
  EXPECT_EQ(share(0.5), 0.8) << "its captions say what is asked for";
}

TEST(Draft, HitsThatTheGateDoesNotTrustAreNotRead) {
  auto stages = tiny_model().stages;
  stages.at("masked").config["evidence_gate"] = toy_gate();
  const pipeline::Generator generator(stages, tiny_words());
  auto hits = posed_hit();
  hits.push_back(hits[0]);
  const auto tokens = [&](double first, double second, GenerateOptions options) {
    hits[0].similarity = first;
    hits[1].similarity = second;
    return generator.generate("a person walks", hits, options);
  };
  GenerateOptions options = following(0), alone = options, all = options;
  alone.use_retrieval = false;
  all.read_untrusted = true;
  EXPECT_EQ(tokens(0.9, 0.7, options).hits_used, 2);
  EXPECT_EQ(tokens(0.9, 0.5, options).hits_used, 1);
  const pipeline::Generated none = tokens(0.5, 0.5, options);
  EXPECT_EQ(none.hits_used, 0);
  EXPECT_TRUE(none.tokens.equal(tokens(0.5, 0.5, alone).tokens)) << "as from the text alone";
  const pipeline::Generated everything = tokens(0.5, 0.5, all);
  EXPECT_EQ(everything.hits_used, 2);
  EXPECT_FALSE(everything.tokens.equal(none.tokens));
  hits[0].caption_similarity = 0.92;
  EXPECT_EQ(tokens(0.5, 0.5, options).hits_used, 1);
}

TEST(Draft, ADamagedGateIsAnError) {
  const std::string sound = R"({"none": 0.6, "all": 0.8})";
  for (const std::string part : {R"({"none": "low", "all": 0.8})", R"({"none": 0.5})", "[]",
                                 R"({"none": 0.9, "all": 0.8})", R"({"none": null, "all": 0.8})"}) {
    for (const std::string& gate : {R"({"motion": )" + part + R"(, "caption": )" + sound + "}",
                                    R"({"motion": )" + sound + R"(, "caption": )" + part + "}",
                                    R"({"motion": )" + sound + "}"}) {
      auto stages = tiny_model().stages;
      stages.at("masked").config["evidence_gate"] = nlohmann::json::parse(gate);
      EXPECT_THROW(pipeline::Generator(stages, tiny_words()), Error) << gate;
    }
  }
}

}  // namespace
}  // namespace remomask
