#pragma once

#include <ATen/core/Tensor.h>

namespace remomask::generator {

/// Inverted dropout: zero with probability `rate` (a multiple of 1/65536), else
/// scaled by 1 / (1 - rate). The mask comes from counters under one draw of
/// torch's generator, so it is the same for any number of threads, and making
/// it costs a tenth of torch's serial Bernoulli. Returns x itself when not
/// `training` or when the rate is 0.
at::Tensor counter_dropout(const at::Tensor& x, double rate, bool training);

}  // namespace remomask::generator
