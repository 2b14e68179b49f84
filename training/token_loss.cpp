#include "training/token_loss.h"

#include <torch/nn/functional/loss.h>

namespace remomask::training {

TokenLoss token_loss(const at::Tensor& logits, const at::Tensor& targets) {
  const auto flat = targets.reshape({-1});
  const auto chosen = torch::nonzero(flat >= 0).squeeze(1);
  TokenLoss result;
  result.targets = chosen.size(0);
  const auto rows = logits.reshape({flat.size(0), logits.size(2)}).index_select(0, chosen);
  const auto wanted = flat.index_select(0, chosen);
  if (result.targets == 0) {
    result.loss = logits.sum() * 0;
    return result;
  }
  result.loss = torch::nn::functional::cross_entropy(rows, wanted);
  result.accuracy = rows.detach().argmax(1).eq(wanted).to(torch::kDouble).mean().item<double>();
  return result;
}

at::Tensor residual_targets(const at::Tensor& tokens, const at::Tensor& level,
                            const at::Tensor& frame_mask) {
  const auto index =
      level.reshape({-1, 1, 1, 1}).expand({tokens.size(0), tokens.size(1), tokens.size(2), 1});
  const auto targets = tokens.gather(3, index).squeeze(3);
  return frame_mask.defined() ? targets.masked_fill(frame_mask.logical_not().unsqueeze(2), -1)
                              : targets;
}

}  // namespace remomask::training
