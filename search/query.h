#pragma once

#include <optional>
#include <string>
#include <vector>

#include "index/vector_table.h"
#include "remomask/error.h"
#include "remomask/search.h"

namespace remomask::search {

/// Numbers of the parts (order of body_parts(), ascending) from their names
/// ("left_arm", ...) or "arms", "legs", "torso". Throws Error for another name.
std::vector<int> parse_body_parts(const std::vector<std::string>& names);

/// What a retriever makes of a query; empty where the query does not have it.
struct QueryVectors {
  std::vector<float> text;                  ///< [E]
  std::vector<float> motion, motion_parts;  ///< [E], [6 P]
};

/// Whether a query is answered by words: a sentence without a motion, unless it says otherwise.
bool asks_by_words(const SearchQuery& query);

/// Throws Error for a query that asks for nothing, or for things that exclude
/// each other.
void check_query(const SearchQuery& query);

/// For a text without a letter or digit.
Error no_word(const std::string& text);

/// The similarity of a query to clips: cos(text, clip), cos(motion, clip), or
/// where body parts were chosen the mean of their cosines; of sentence and
/// motion together the mean by weight.
index::LinearQuery linear_query(const QueryVectors& vectors, const SearchQuery& query);

/// Seconds [from, to) of a motion (20 fps) as a canonical motion of its own; no
/// `to`: up to its end. Throws Error when nothing is left.
Motion cut_motion(const Motion& motion, double from, const std::optional<double>& to);

}  // namespace remomask::search
