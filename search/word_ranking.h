#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "remomask/search.h"
#include "search/search_scene.h"
#include "search/word_index.h"
#include "search/word_score.h"

namespace remomask::search {

/// A sentence, or its mirror image, with all that it is compared by.
struct WordVariant {
  std::string text;
  bool mirrored = false;             ///< the sentence with left and right exchanged
  std::vector<float> caption_query;  ///< vector of the sentence encoder
  std::vector<float> motion_query;   ///< vector of the retriever [E]
  std::vector<QueryTerm> terms;
};

/// A clip that answers a sentence.
struct RankedClip {
  int64_t clip_id = 0;
  size_t place = 0;  ///< in SearchState::clips
  bool as_mirrored = false;
  double score = 0;  ///< what the ranking is by: log-odds, cosine or share of the best BM25
  double probability = 0;
  WordParts parts;
};

/// The clips that the scene allows and that have something to compare, best first; equal scores by
/// id, and the clip before its mirror image. A clip comes a second time, as its mirror image, where
/// it has a caption that names a side and `variants` holds the mirrored sentence: the image of a
/// clip answers a sentence as the clip itself answers the mirrored one. At least the first `count`
/// are there and have their place among all clips; what comes after them may have gaps.
std::vector<RankedClip> rank_clips(const SearchScene& scene,
                                   const std::vector<WordVariant>& variants, const WordScore& score,
                                   SearchBy by, size_t count);

}  // namespace remomask::search
