#include "pipeline/evidence.h"

#include <algorithm>
#include <numeric>

namespace remomask {

const char* evidence_use_name(EvidenceUse use) {
  switch (use) {
    case EvidenceUse::read:
      return "read";
    case EvidenceUse::untrusted:
      return "untrusted";
    case EvidenceUse::after_untrusted:
      return "after_untrusted";
    case EvidenceUse::no_captions:
      return "no_captions";
  }
  return "";
}

}  // namespace remomask

namespace remomask::pipeline {

FoundEvidence find_evidence(const Generator& generator, const EvidenceSource& source,
                            const std::string& sentence, const GenerateOptions& options) {
  FoundEvidence result;
  const auto k = static_cast<int>(generator.max_hits());
  if (!options.use_retrieval || k == 0) return result;
  const std::vector<float> query = generator.sentence_vector(sentence);
  for (search::FoundClip& found : source.find(query, k, options.evidence)) {
    Evidence evidence;
    evidence.hit = found.hit;
    if (found.text.empty()) {
      evidence.use = EvidenceUse::no_captions;
      result.evidence.push_back(std::move(evidence));
      continue;
    }
    RetrievedMotion motion;
    motion.clip_id = found.hit.clip.id;
    motion.similarity = found.hit.similarity;
    motion.caption_similarity =
        std::inner_product(query.begin(), query.end(), found.text.begin(), 0.0);
    motion.frames = found.hit.clip.frames;
    motion.motion = std::move(found.motion);
    motion.text = std::move(found.text);
    if (options.follow > 0 ||
        static_cast<int64_t>(result.motions.size()) < generator.sequence_hits()) {
      motion.poses = source.motion(motion.clip_id);
    }
    evidence.caption_similarity = motion.caption_similarity;
    evidence.trust = generator.trust(motion);
    result.evidence.push_back(std::move(evidence));
    result.motions.push_back(std::move(motion));
  }
  const size_t read = generator.read_hits(result.motions, options).size();
  size_t place = 0;
  for (Evidence& evidence : result.evidence) {
    if (evidence.use == EvidenceUse::no_captions) continue;
    evidence.use = place < read    ? EvidenceUse::read
                   : place == read ? EvidenceUse::untrusted
                                   : EvidenceUse::after_untrusted;
    ++place;
  }
  return result;
}

void note_followed(std::vector<Evidence>& evidence, const std::optional<FollowedHit>& followed) {
  if (!followed) return;
  const auto found = std::find_if(evidence.begin(), evidence.end(), [&](const Evidence& entry) {
    return entry.hit.clip.id == followed->clip_id;
  });
  if (found != evidence.end()) found->followed_share = followed->share;
}

void note_influence(FoundEvidence& found, const std::vector<double>& shares) {
  for (size_t i = 0; i < shares.size(); ++i) {
    for (Evidence& evidence : found.evidence) {
      if (evidence.hit.clip.id == found.motions[i].clip_id) evidence.influence = shares[i];
    }
  }
}

}  // namespace remomask::pipeline
