#pragma once

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "db/database.h"
#include "index/vector_index.h"
#include "index/vector_table.h"
#include "search/calibration.h"
#include "search/caption_table.h"

namespace remomask::search {

/// One state of a database, shared by all searches in it.
struct SearchState {
  index::VectorIndex index;
  std::vector<db::Clip> clips;                                   ///< by id
  std::unordered_map<std::string, std::vector<int64_t>> groups;  ///< Clip::group -> ids
  std::shared_ptr<const index::VectorTable> bodies, captions;    ///< read when first needed
  std::shared_ptr<const CaptionTable> caption_table;             ///< likewise

  SearchState(index::VectorIndex vector_index, std::vector<db::Clip> all_clips);

  const db::Clip& clip(int64_t id) const;
};

/// All that one search reads from the database.
struct SearchScene {
  std::shared_ptr<const SearchState> state;
  std::shared_ptr<const index::VectorTable> bodies, captions;
  std::shared_ptr<const CaptionTable> caption_table;  ///< of a search by words
  std::optional<std::vector<int64_t>> allowed;        ///< ids that pass the filter, ascending
  std::vector<int64_t> boosted;                       ///< have boost words, best first
  std::optional<Calibration> calibration;             ///< of queries by a sentence alone
  std::optional<db::ClipEmbedding> like;              ///< vectors of SearchQuery::like_clip

  const std::vector<int64_t>* limit() const { return allowed ? &*allowed : nullptr; }
  /// How many of these clips are embedded and pass the filter.
  int64_t candidates(const std::vector<int64_t>& ids) const;
};

}  // namespace remomask::search
