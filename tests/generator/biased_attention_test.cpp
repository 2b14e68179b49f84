#include "generator/biased_attention.h"

#include <gtest/gtest.h>
#include <torch/types.h>

namespace remomask {
namespace {

struct AttentionInputs {
  std::vector<at::Tensor> all;  // q, k, v, position, key

  at::Tensor attend() const {
    return generator::biased_attention(all[0], all[1], all[2], all[3], all[4]);
  }
};

AttentionInputs random_attention_inputs(int64_t batch, int64_t count, int64_t extra, int64_t heads,
                                        int64_t head_width) {
  torch::manual_seed(41);
  const int64_t width = heads * head_width;
  AttentionInputs inputs{
      {torch::randn({batch, count, width}), torch::randn({batch, count + extra, width}),
       torch::randn({batch, count + extra, width}), torch::randn({heads, count, count}),
       torch::randn({batch, heads, count + extra})}};
  inputs.all[4].index_put_({torch::rand({batch, heads, count + extra}) < 0.2}, -1e4f);
  return inputs;
}

/// The float kernel against the composed operations in double.
void expect_kernel_equals_composed(const AttentionInputs& inputs) {
  AttentionInputs exact;
  for (auto& x : inputs.all) {
    exact.all.push_back(x.to(torch::kDouble).requires_grad_());
    x.requires_grad_();
  }
  const at::Tensor out = inputs.attend(), expected = exact.attend();
  EXPECT_LT((out - expected).abs().max().item<double>(), 2e-6);
  const at::Tensor weight = torch::randn(out.sizes());
  (out * weight).sum().backward();
  (expected * weight).sum().backward();
  for (size_t i = 0; i < inputs.all.size(); ++i) {
    EXPECT_LT((inputs.all[i].grad() - exact.all[i].grad()).abs().max().item<double>(), 2e-5)
        << "gradient " << i;
  }
}

TEST(BiasedAttention, KernelEqualsComposedOperations) {
  expect_kernel_equals_composed(random_attention_inputs(3, 12, 7, 2, 16));
}

TEST(BiasedAttention, KernelHandlesSizesThatFillNoVector) {
  expect_kernel_equals_composed(random_attention_inputs(2, 5, 1, 3, 6));
  expect_kernel_equals_composed(random_attention_inputs(1, 1, 0, 1, 2));
  expect_kernel_equals_composed(random_attention_inputs(11, 49, 26, 2, 20));
}

TEST(BiasedAttention, HiddenKeysHaveNoInfluence) {
  AttentionInputs inputs = random_attention_inputs(1, 6, 4, 2, 8);
  inputs.all[4].zero_();
  inputs.all[4].select(2, 7).fill_(-1e4f);
  const at::Tensor before = inputs.attend();
  inputs.all[1].select(1, 7).normal_();
  inputs.all[2].select(1, 7).fill_(1e3f);
  EXPECT_TRUE(torch::equal(before, inputs.attend()));
}

}  // namespace
}  // namespace remomask
