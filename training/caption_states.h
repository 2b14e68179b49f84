#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "encoders/text_tower.h"
#include "remomask/progress.h"

namespace remomask::training {

/// The states that the frozen layers of a sentence encoder give to captions, computed once: a
/// training that resumes reads the same bits as one that was never stopped.
class CaptionStates {
 public:
  /// Each of `captions` once, in batches of their order. `left_out`: last layers that are not
  /// applied (TextTower::encode_below). Throws Interrupted when asked to stop.
  CaptionStates(const encoders::TextTower& tower, const std::vector<std::string>& captions,
                int64_t left_out, const Monitor& monitor);

  /// [B, S, W] for captions that were given, with zeros behind the end of shorter ones; S is that
  /// of their `tokens`.
  at::Tensor states(const std::vector<std::string>& captions,
                    const encoders::TokenBatch& tokens) const;

 private:
  std::unordered_map<std::string, at::Tensor> states_;  // [length, W] each
};

}  // namespace remomask::training
