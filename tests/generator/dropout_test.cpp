#include "generator/dropout.h"

#include <gtest/gtest.h>
#include <torch/types.h>

#include "nn/threads.h"

namespace remomask {
namespace {

TEST(CounterDropout, DropsTheShareAndKeepsTheMean) {
  torch::manual_seed(71);
  const auto x = torch::ones({1001, 101});
  const auto y = generator::counter_dropout(x, 0.1, true);
  EXPECT_NEAR((y == 0).to(torch::kDouble).mean().item<double>(), 0.1, 0.004);
  EXPECT_NEAR(y.mean().item<double>(), 1, 0.004);
  EXPECT_NEAR(y.max().item<double>(), 1 / 0.9, 1e-4);
  EXPECT_FALSE(torch::equal(y, generator::counter_dropout(x, 0.1, true)));
  EXPECT_TRUE(torch::equal(x, generator::counter_dropout(x, 0.1, false)));
  EXPECT_TRUE(torch::equal(x, generator::counter_dropout(x, 0, true)));
}

TEST(CounterDropout, MaskDependsOnTheSeedNotOnThreads) {
  const auto x = torch::ones({300, 257});
  std::vector<at::Tensor> results;
  for (const int threads : {1, 4}) {
    nn::set_compute_threads(threads);
    torch::manual_seed(72);
    results.push_back(generator::counter_dropout(x, 0.3, true));
  }
  nn::set_compute_threads(0);
  EXPECT_TRUE(torch::equal(results[0], results[1]));
}

}  // namespace
}  // namespace remomask
