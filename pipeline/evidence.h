#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/motion_generator.h"
#include "remomask/generation.h"
#include "search/motion_search.h"

namespace remomask::pipeline {

/// Where motions are retrieved from. Const functions may be called from several threads.
class EvidenceSource {
 public:
  virtual ~EvidenceSource() = default;

  /// The `k` clips that answer a sentence best, one of each group. `query` is its vector [E].
  virtual search::FoundClips find(const std::string& sentence, const std::vector<float>& query,
                                  int k, const ClipFilter& filter) const = 0;
  /// The joints of a clip that find() returned.
  virtual Motion motion(int64_t clip_id) const = 0;
};

/// The motions retrieved for a sentence: as people read them, and as the networks do.
struct FoundEvidence {
  std::vector<Evidence> evidence;        ///< every hit
  std::vector<RetrievedMotion> motions;  ///< the hits that have captions, in the same order
  std::vector<QueryWord> words;          ///< of the sentence
};

/// Retrieves for a sentence what the generator can read. This is the only place where evidence
/// is made. Nothing is retrieved without `options.use_retrieval` or for a model that reads no
/// hits.
FoundEvidence find_evidence(const Generator& generator, const EvidenceSource& source,
                            const std::string& sentence, const GenerateOptions& options);

/// Enters the hit that a motion started from.
void note_followed(std::vector<Evidence>& evidence, const std::optional<FollowedHit>& followed);

/// Enters what each hit that was read contributed; `shares` is what hit_influence() returned.
void note_influence(FoundEvidence& found, const std::vector<double>& shares);

}  // namespace remomask::pipeline
