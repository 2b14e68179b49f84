#include "pipeline/influence.h"

#include <gtest/gtest.h>
#include <torch/types.h>

#include "motion/features.h"
#include "tests/generator/tiny_model.h"
#include "tests/pipeline/pipeline_test_tools.h"

namespace remomask {
namespace {

TEST(HitInfluence, TheHitThatIsFollowedDecides) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  auto hits = two_hits();
  hits[0].poses = motion::recover_motion(swinging_clips({40})[0].features, humanml_skeleton());
  GenerateOptions options;
  options.seconds = 2;
  options.follow = 1;
  const pipeline::Generated made = generator.generate("a person walks", hits, options);
  ASSERT_EQ(made.hits_used, 2);
  const std::vector<double> influence =
      pipeline::hit_influence(generator, "a person walks", hits, options, made);
  ASSERT_EQ(influence.size(), 2u);
  EXPECT_EQ(influence[1], 0) << "a motion that is the first hit does not need the second";
  // By hand: the share of tokens in which the motion differs from the one without the first hit.
  const pipeline::Generated without = generator.generate("a person walks", {hits[1]}, options);
  const double differ = without.tokens.select(2, 0)
                            .ne(made.tokens.select(2, 0))
                            .to(torch::kDouble)
                            .mean()
                            .item<double>();
  EXPECT_GT(influence[0], 0);
  EXPECT_NEAR(influence[0], differ, 1e-12);
  EXPECT_TRUE(pipeline::hit_influence(generator, "a person walks", {}, options,
                                      generator.generate("a person walks", {}, options))
                  .empty());
}

}  // namespace
}  // namespace remomask
