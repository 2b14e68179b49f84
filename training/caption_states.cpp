#include "training/caption_states.h"

#include <torch/types.h>

#include <algorithm>

#include "remomask/error.h"

namespace remomask::training {

namespace {
constexpr size_t kCaptionsAtOnce = 64;
}

CaptionStates::CaptionStates(const encoders::TextTower& tower,
                             const std::vector<std::string>& captions, int64_t left_out,
                             const Monitor& monitor) {
  const at::NoGradGuard no_grad;
  std::vector<std::string> distinct;
  for (const std::string& caption : captions) {
    if (states_.emplace(caption, at::Tensor()).second) distinct.push_back(caption);
  }
  for (size_t first = 0; first < distinct.size(); first += kCaptionsAtOnce) {
    if (monitor.stop_requested()) throw Interrupted("encoding captions stopped");
    const size_t last = std::min(distinct.size(), first + kCaptionsAtOnce);
    const std::vector<std::string> some(distinct.begin() + static_cast<std::ptrdiff_t>(first),
                                        distinct.begin() + static_cast<std::ptrdiff_t>(last));
    const encoders::TokenBatch tokens = tower.tokenize(some);
    const at::Tensor states = tower.encode_below(tokens.ids, tokens.mask, left_out);
    for (size_t i = 0; i < some.size(); ++i) {
      const auto row = static_cast<int64_t>(i);
      const auto length = tokens.mask[row].sum().item<int64_t>();
      states_[some[i]] = states[row].slice(0, 0, length).clone();
    }
    monitor.report(
        {"encode captions", static_cast<double>(last), static_cast<double>(distinct.size()), ""});
  }
}

at::Tensor CaptionStates::states(const std::vector<std::string>& captions,
                                 const encoders::TokenBatch& tokens) const {
  const int64_t width = states_.at(captions.front()).size(1);
  const at::Tensor padded =
      torch::zeros({static_cast<int64_t>(captions.size()), tokens.ids.size(1), width});
  for (size_t i = 0; i < captions.size(); ++i) {
    const at::Tensor& own = states_.at(captions[i]);
    padded[static_cast<int64_t>(i)].slice(0, 0, own.size(0)).copy_(own);
  }
  return padded;
}

}  // namespace remomask::training
