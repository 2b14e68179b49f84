#include "search/moments.h"
#include "motion/vector.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include "motion/canonical.h"
#include "remomask/error.h"
#include "synthetic/procedural.h"
#include "tests/retriever/retriever_test_tools.h"

namespace remomask {
namespace {

TEST(Moments, IntersectionOverUnionByHand) {
  EXPECT_DOUBLE_EQ(search::temporal_iou({0, 10}, {0, 10}), 1);
  EXPECT_DOUBLE_EQ(search::temporal_iou({0, 10}, {5, 20}), 5. / 20);
  EXPECT_DOUBLE_EQ(search::temporal_iou({5, 20}, {0, 10}), 5. / 20);
  EXPECT_DOUBLE_EQ(search::temporal_iou({0, 30}, {10, 20}), 10. / 30);
  EXPECT_DOUBLE_EQ(search::temporal_iou({0, 10}, {10, 20}), 0);
  EXPECT_DOUBLE_EQ(search::temporal_iou({0, 10}, {40, 50}), 0);
}

TEST(Moments, WindowsByHand) {
  const search::MomentOptions options{{80, 40}, 30};
  using Windows = std::vector<search::MomentWindow>;
  EXPECT_EQ(search::moment_windows(100, options),
            (Windows{{0, 40}, {30, 70}, {60, 100}, {0, 80}, {20, 100}}));
  EXPECT_EQ(search::moment_windows(110, options),
            (Windows{{0, 40}, {30, 70}, {60, 100}, {70, 110}, {0, 80}, {30, 110}}));
  // Shorter than the longest window: the whole motion is one too, once.
  EXPECT_EQ(search::moment_windows(60, options), (Windows{{0, 40}, {20, 60}, {0, 60}}));
  EXPECT_EQ(search::moment_windows(40, options), (Windows{{0, 40}}));
  EXPECT_EQ(search::moment_windows(12, options), (Windows{{0, 12}}));
}

TEST(Moments, BadOptionsAndWindowsAreRefused) {
  EXPECT_THROW(search::moment_windows(100, {{}, 10}), Error);
  EXPECT_THROW(search::moment_windows(100, {{3}, 10}), Error);
  EXPECT_THROW(search::moment_windows(100, {{40}, 0}), Error);
  EXPECT_THROW(search::moment_windows(100, {{60, 40}, 41}), Error);
  EXPECT_THROW(search::moment_windows(3, {}), Error);
  const retriever::Retriever retriever = untrained_retriever(1);
  const motion::Features features = random_features(50, 1);
  EXPECT_THROW(search::encode_moments(retriever, features, {{10, 51}}), Error);
  EXPECT_THROW(search::encode_moments(retriever, features, {{-1, 20}}), Error);
  EXPECT_THROW(search::encode_moments(retriever, features, {{20, 20}}), Error);
  EXPECT_EQ(search::encode_moments(retriever, features, {}).size(0), 0);
}

TEST(Moments, AWindowIsWhatACutClipWouldBe) {
  synthetic::ProceduralParameters parameters;
  parameters.duration = 8;
  const Motion motion = synthetic::make_procedural_clip("walk-circle-left", parameters).motion;
  ASSERT_GT(motion.frames, 120);
  const motion::Features features =
      motion::extract_features_all_frames(motion, humanml_skeleton(), motion::FeatureMode::fixed);
  const search::MomentWindow window{45, 105};
  // Its own origin, heading and floor.
  const Motion cut =
      motion::canonicalize(slice(motion, window.first, window.last), humanml_skeleton());
  EXPECT_GT((joint_position(motion, window.first, 0) - joint_position(cut, 0, 0)).norm(), 0.5);
  const motion::Features expected =
      motion::extract_features_all_frames(cut, humanml_skeleton(), motion::FeatureMode::fixed);
  // The smoothing of the heading sees 12 frames to both sides.
  for (int t = 12; t + 13 < expected.frames; ++t) {
    for (int c = 0; c < expected.dim; ++c) {
      EXPECT_NEAR(features.row(window.first + t)[c], expected.row(t)[c], 0.01) << t << ' ' << c;
    }
  }
  const retriever::Retriever retriever = untrained_retriever(1);
  const at::Tensor whole =
      search::encode_moments(retriever, features, {{0, motion.frames}, window});
  const at::Tensor clip = retriever.encode_motion({&expected}).global;
  EXPECT_GT(whole[1].dot(clip[0]).item<float>(), 0.99f);
}

TEST(Moments, VectorsKeepTheOrderOfTheWindows) {
  const retriever::Retriever retriever = untrained_retriever(1);
  const motion::Features features = random_features(150, 3);
  const std::vector<search::MomentWindow> windows = search::moment_windows(150, {{20, 40}, 2});
  ASSERT_GT(windows.size(), 64u);  // several batches
  const at::Tensor vectors = search::encode_moments(retriever, features, windows);
  EXPECT_EQ(vectors.size(0), static_cast<int64_t>(windows.size()));
  for (const size_t w : {size_t{0}, size_t{64}, windows.size() - 1}) {
    motion::Features part(windows[w].last - windows[w].first, features.dim);
    std::copy_n(features.row(windows[w].first), part.values.size(), part.values.begin());
    const at::Tensor alone = retriever.encode_motion({&part}).global[0];
    EXPECT_TRUE(torch::allclose(vectors[static_cast<int64_t>(w)], alone, 1e-4, 1e-4)) << w;
  }
}

/// Windows of four frames, one at each start, and vectors that have the given
/// cosines with the query (1, 0).
std::vector<search::Moment> moments_of(const std::vector<float>& cosines, size_t count,
                                       const search::MomentOptions& options) {
  std::vector<search::MomentWindow> windows;
  std::vector<at::Tensor> vectors;
  for (size_t i = 0; i < cosines.size(); ++i) {
    windows.push_back({4 * static_cast<int>(i), 4 * static_cast<int>(i) + 4});
    vectors.push_back(torch::tensor({cosines[i], 0.f}));
  }
  return search::best_moments(torch::tensor({1.f, 0.f}), windows, torch::stack(vectors), count,
                              options);
}

TEST(Moments, FrameSimilaritiesByHand) {
  const auto curve = search::frame_similarities({{0, 4}, {2, 6}, {2, 3}}, {1.f, 0.f, 0.5f});
  const std::vector<double> expected = {1, 1, 0.5, 0.5, 0, 0};
  EXPECT_EQ(curve, expected);
}

TEST(Moments, StretchAboveTheThresholdByHand) {
  search::MomentOptions options;
  options.lengths = {4};
  // Threshold min(0.9 - 0.2, 0 + 0.7 x 0.9) = 0.63: the gap at 0.5 costs less than
  // what lies behind it brings, 0.4 does not pay.
  const auto found = moments_of({0, 0.9f, 0.8f, 0.5f, 0.9f, 0.4f, 0.7f, 0.1f}, 1, options);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].window, (search::MomentWindow{4, 20}));
  EXPECT_NEAR(found[0].similarity, (0.9 + 0.8 + 0.5 + 0.9) / 4, 1e-6);
  // All alike, within the margin: the whole motion.
  const auto whole = moments_of({0.6f, 0.5f, 0.7f, 0.55f}, 1, options);
  EXPECT_EQ(whole[0].window, (search::MomentWindow{0, 16}));
}

TEST(Moments, SeveralMomentsDoNotOverlap) {
  search::MomentOptions options;
  options.lengths = {4};
  const auto found = moments_of({0.9f, 0.9f, 0, 0, 0.8f, 0, 0}, 3, options);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].window, (search::MomentWindow{0, 8}));
  EXPECT_EQ(found[1].window, (search::MomentWindow{16, 20}));
  EXPECT_EQ(found[2].window,
            (search::MomentWindow{8, 16}));  // what is left, the first of equal ones
  EXPECT_NEAR(found[2].similarity, 0, 1e-6);
  EXPECT_EQ(moments_of({0.5f}, 5, options).size(), 1u);
  EXPECT_TRUE(moments_of({0.5f}, 0, options).empty());
}

}  // namespace
}  // namespace remomask
