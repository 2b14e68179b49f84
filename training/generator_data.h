#pragma once

#include <cstdint>
#include <vector>

#include "db/training_set.h"
#include "generator/condition.h"
#include "remomask/progress.h"
#include "retriever/retriever.h"
#include "tokenizer/tokenizer.h"
#include "training/retrieval_table.h"

namespace remomask::training {

/// Text features of many captions, states of all of them one after the other.
struct CaptionFeatures {
  at::Tensor states;             ///< [sum of lengths, text_width]
  std::vector<int64_t> offsets;  ///< [N + 1] first state of each caption
  at::Tensor query;              ///< [N, E]
};

/// A clip as the transformers see it.
struct TokenClip {
  std::vector<at::Tensor> tokens;  ///< int64 [T, rows, levels] each, one a frame offset
  std::vector<int64_t> captions;   ///< indices into CaptionFeatures
  int64_t first_query = 0;         ///< row of its first caption in the retrieval table
  int group = 0;
  int meaning = 0;    ///< equal for clips of equal content and style, else unlike
  size_t source = 0;  ///< number of the TrainingClip it was made from
};

struct TokenSplit {
  std::vector<TokenClip> clips;
  RetrievalTable hits;  ///< one row for each caption of each clip
  /// The same among the motions that do not show the content in the style of the clip,
  /// which is what a prompt finds whose pair of both is in no database.
  RetrievalTable unfamiliar_hits;
};

/// Everything that training the transformers needs, computed once: tokens,
/// text features, and whom retrieval finds among the training clips.
struct GeneratorData {
  int64_t rows = 0, levels = 0, codes = 0;
  CaptionFeatures captions;
  TokenSplit train, val;
  at::Tensor motion;       ///< [N, E] R_m of the training clips
  at::Tensor motion_text;  ///< [N, E] R_t: mean of their captions' vectors, L2-normalised
};

/// Encodes both splits: tokens at frame offsets 0 and 2 (validation: 0), every
/// distinct caption once. Clips without captions or of fewer than 8 frames are
/// left out. Throws Error when no training clip is left.
GeneratorData prepare_generator_data(const std::vector<db::TrainingClip>& train,
                                     const std::vector<db::TrainingClip>& val,
                                     const tokenizer::Tokenizer& tokenizer,
                                     const retriever::Retriever& retriever, const Monitor& monitor);

/// One sample of a batch of conditions.
struct ConditionSample {
  int64_t caption = 0;
  std::vector<DrawnHit> hits;
  bool use_text = true, use_retrieval = true;
};

/// Text padded to the longest of the batch, hits to `max_hits`; the tokens of
/// the best `sequence_hits` of them.
generator::Condition make_condition(const GeneratorData& data,
                                    const std::vector<ConditionSample>& samples, int64_t max_hits,
                                    int64_t sequence_hits);

/// Clips of similar length in batches of at most `batch`: shuffled, sorted by
/// length inside blocks of eight batches, batches shuffled again. A function of
/// (clips, seed, epoch).
std::vector<std::vector<size_t>> length_buckets(const std::vector<TokenClip>& clips, int64_t batch,
                                                uint64_t seed, uint64_t epoch);

/// Token maps padded to the longest: tokens [B, T, rows, levels] (0 where no
/// frame is) and frame_mask [B, T], undefined when all have one length.
struct PaddedTokens {
  at::Tensor tokens, frame_mask;
};
PaddedTokens pad_tokens(const std::vector<at::Tensor>& maps);

}  // namespace remomask::training
