#pragma once

#include <ATen/core/Tensor.h>

#include <string>
#include <vector>

#include "db/training_set.h"

namespace remomask::evaluation {

/// What is searched and what counts as found. `all`, `threshold`, `dissimilar`
/// and `small_batch` are (a) to (d) of TMR (Petrovich et al., ICCV 2023);
/// `duplicates` is the one of ReMoMask's retriever and MotionPatches, with
/// windows and twins of a motion correct too.
enum class RetrievalProtocol { all, threshold, dissimilar, small_batch, duplicates };

inline constexpr RetrievalProtocol kRetrievalProtocols[] = {
    RetrievalProtocol::all, RetrievalProtocol::threshold, RetrievalProtocol::dissimilar,
    RetrievalProtocol::small_batch, RetrievalProtocol::duplicates};

const char* retrieval_protocol_name(RetrievalProtocol protocol);
/// "all", "threshold", "dissimilar", "small-batch" or "duplicates"; Error for others.
RetrievalProtocol parse_retrieval_protocol(const std::string& name);

/// Captions with the clips that they belong to.
struct CaptionSet {
  std::vector<std::string> texts;
  std::vector<size_t> clips;  ///< of each text, ascending
};

/// The first caption of each clip that has one, or all of them.
CaptionSet caption_set(const std::vector<db::TrainingClip>& clips, bool all_captions);

struct ProtocolSettings {
  /// `threshold`: captions above it are the same, on the scale (1 + cosine) / 2
  /// of TMR; the cosine is that of CaptionSimilarity.
  double threshold = 0.95;
  size_t dissimilar = 100;  ///< clips of `dissimilar`
  size_t batch = 32;        ///< clips of each gallery of `small_batch`
  uint64_t seed = 0;        ///< of its permutation
};

/// One protocol laid out for one split.
struct ProtocolPlan {
  std::vector<std::vector<size_t>> galleries;  ///< clips that are searched together
  at::Tensor correct;                          ///< [captions, clips] bool
};

/// `all`, `threshold`, `duplicates`: one gallery of all clips. `dissimilar`: one
/// of the clips that dissimilar_clips() chooses. `small_batch`: clips with a
/// caption, sorted by name, permuted, cut into batches; the last incomplete one
/// is left out, unless it is the only one.
ProtocolPlan protocol_plan(RetrievalProtocol protocol, const CaptionSet& captions,
                           const std::vector<db::TrainingClip>& clips,
                           const ProtocolSettings& settings = {});

/// What the figures of a protocol mean, in one sentence that belongs beside them.
std::string retrieval_definition(RetrievalProtocol protocol, const ProtocolSettings& settings);

/// At most `count` clips that are unlike in words: begins with the caption of
/// the least mean similarity to the others and adds the one whose greatest
/// similarity to the chosen is least (farthest first); first caption of each
/// clip, at most one clip a group, ties to the lower number. Ascending.
std::vector<size_t> dissimilar_clips(const CaptionSet& captions,
                                     const std::vector<db::TrainingClip>& clips, size_t count);

}  // namespace remomask::evaluation
