#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "db/training_set.h"
#include "evaluation/label_figures.h"
#include "evaluation/recall.h"
#include "evaluation/retrieval_protocols.h"
#include "remomask/progress.h"
#include "retriever/retriever.h"

namespace remomask::evaluation {

struct RetrievalOptions {
  std::vector<RetrievalProtocol> protocols{std::begin(kRetrievalProtocols),
                                           std::end(kRetrievalProtocols)};
  bool all_captions = false;  ///< every caption of a clip, not the first alone
  ProtocolSettings settings;
  BootstrapOptions bootstrap;
};

struct DirectionFigures {
  RecallFigures recall;
  LabelFigures labels;
};

struct RetrievalSubset {
  std::string name;  ///< "all", "take" or "pair" (TrainingClip::unseen of the query's clip)
  DirectionFigures text_to_motion, motion_to_text;
};

struct ProtocolEvaluation {
  RetrievalProtocol protocol = RetrievalProtocol::all;
  std::string definition;
  std::string gallery_hash;              ///< of the names of the clips that were searched
  std::vector<RetrievalSubset> subsets;  ///< "all" first; subsets without queries are left out
};

/// Figures of one split with everything that they depend on.
struct RetrievalEvaluation {
  size_t clips = 0;
  std::string split_hash;  ///< clip_set_hash of the split
  std::string captions;    ///< which captions are used, and the rules common to all protocols
  BootstrapOptions bootstrap;
  std::vector<ProtocolEvaluation> protocols;
};

void to_json(nlohmann::json& json, const RetrievalEvaluation& evaluation);

/// content_hash of the clips' names, sorted, one a line: equal for equal splits.
std::string clip_set_hash(const std::vector<db::TrainingClip>& clips);

/// Vectors of one split: row t of `text` belongs to captions.texts[t], row c of
/// `motion` to clips[c].
struct EncodedSplit {
  CaptionSet captions;
  at::Tensor text;               ///< [T, E]
  at::Tensor motion;             ///< [N, E]
  at::Tensor text_parts = {};    ///< [T, 6, P]
  at::Tensor motion_parts = {};  ///< [N, 6, P]
};

/// Vectors [T, E] and part vectors [T, 6, P] of texts, which must not be none;
/// `progress` is told how many are done.
std::pair<at::Tensor, at::Tensor> encode_texts(const retriever::Retriever& retriever,
                                               const std::vector<std::string>& texts,
                                               const std::function<void(size_t)>& progress);

/// Throws Error when no clip has a caption.
EncodedSplit encode_split(const retriever::Retriever& retriever,
                          const std::vector<db::TrainingClip>& clips, bool all_captions,
                          const Monitor& monitor = {});

/// Both directions over the split `clips`; "take" and "pair" restrict the queries
/// alone. Text queries are `split.captions`; the gallery of motion-to-text has the
/// same captions. Clips without captions only stand in galleries of motions.
RetrievalEvaluation evaluate_encoded(const EncodedSplit& split,
                                     const std::vector<db::TrainingClip>& clips,
                                     const RetrievalOptions& options);

/// Encodes and evaluates.
RetrievalEvaluation evaluate_retrieval(const retriever::Retriever& retriever,
                                       const std::vector<db::TrainingClip>& clips,
                                       const RetrievalOptions& options,
                                       const Monitor& monitor = {});

}  // namespace remomask::evaluation
