#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "remomask/search.h"
#include "search/search_scene.h"
#include "search/word_score.h"

namespace remomask::search {

/// A sentence, or its mirror image, with all that it is compared by.
struct WordVariant {
  std::string text;
  bool mirrored = false;                       ///< the sentence with left and right exchanged
  std::vector<float> caption_query;            ///< vector of the sentence encoder
  std::vector<float> motion_query;             ///< vector of the retriever [E]
  std::vector<db::CaptionMatch> matches;       ///< clips with its words, best first
  std::unordered_map<int64_t, double> shares;  ///< clip -> WordFeatures::share
};

/// A clip that answers a sentence.
struct RankedClip {
  int64_t clip_id = 0;
  bool as_mirrored = false;
  double score = 0;  ///< what the ranking is by: log-odds, cosine or share of the best BM25
  double probability = 0;
  WordParts parts;
};

/// All clips that the scene allows and that have something to compare, best first; equal scores by
/// id, and the clip before its mirror image. A clip comes a second time, as its mirror image, where
/// it has a caption that names a side and `variants` holds the mirrored sentence: the image of a
/// clip answers a sentence as the clip itself answers the mirrored one.
std::vector<RankedClip> rank_clips(const SearchScene& scene,
                                   const std::vector<WordVariant>& variants, const WordScore& score,
                                   SearchBy by);

/// Sides that a text names: bit 0 left, bit 1 right.
unsigned named_sides(const std::string& text);

}  // namespace remomask::search
