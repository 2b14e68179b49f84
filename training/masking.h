#pragma once

#include <cstdint>
#include <vector>

#include "base/random.h"

namespace remomask::training {

/// How the target tokens of a training sample are chosen. In all of them
/// p = cos(pi/2 u), u uniform.
enum class MaskKind {
  time_space,  ///< round(p T) whole frames, then round(p n) of all tokens by random rank (ReMoMask)
  random,      ///< round(p n) tokens (MoMask; what decoding meets)
  rows,        ///< 1 .. rows-1 whole rows: editing of body parts
  section      ///< round(p T) frames in a row: editing of time spans
};

/// 50 % time_space, 25 % random, 15 % rows, 10 % section; maps of one row have
/// no body parts: their share goes to random.
MaskKind draw_mask_kind(int64_t rows, CounterRandom& random);

/// True for every target of a map of `frames` x `rows` (time-major). At least
/// one target. `ratio` is p; the rows kind ignores it.
std::vector<bool> draw_mask(MaskKind kind, int64_t frames, int64_t rows, double ratio,
                            CounterRandom& random);

/// What becomes of a target in the input (BERT): 80 % MASK, 10 % a random code,
/// 10 % unchanged, drawn for each token.
int64_t corrupt_token(int64_t token, int64_t codes, int64_t mask_token, CounterRandom& random);

/// Which conditions a training sample keeps: none 10 %, text only 5 %,
/// retrieval only 5 %, both 80 % (RAG classifier-free guidance).
struct ConditionDrop {
  bool use_text = true, use_retrieval = true;
};
ConditionDrop draw_condition_drop(CounterRandom& random);

}  // namespace remomask::training
