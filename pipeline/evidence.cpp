#include "pipeline/evidence.h"

#include <algorithm>
#include <numeric>

#include "motion/canonical.h"
#include "motion/features.h"
#include "nn/tensor_values.h"
#include "text/caption.h"
#include "text/caption_mirror.h"

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

namespace {

double cosine(const std::vector<float>& left, const std::vector<float>& right) {
  return std::inner_product(left.begin(), left.end(), right.begin(), 0.0);
}

/// Makes of a hit its mirror image: the vectors are made anew; returns the mirrored motion.
Motion mirror_hit(const Generator& generator, const EvidenceSource& source,
                  search::FoundClip& found) {
  const retriever::Retriever& retriever = generator.retriever();
  const Skeleton& skeleton = generator.skeleton();
  const Motion image = motion::mirror_motion(source.motion(found.hit.clip.id), skeleton);
  const motion::Features features =
      motion::extract_features_all_frames(image, skeleton, retriever.feature_mode());
  found.motion = nn::float_vector(retriever.encode_motion({&features}).global[0]);
  std::vector<std::string> captions;
  for (const std::string& caption : found.hit.clip.captions) {
    const std::string mirrored = text::mirror_caption(text::normalise_caption(caption));
    if (!mirrored.empty()) captions.push_back(mirrored);
  }
  const at::Tensor mean = retriever.encode_text(captions).query.mean(0);
  found.text = nn::float_vector(mean / mean.norm());
  return image;
}

}  // namespace

FoundEvidence find_evidence(const Generator& generator, const EvidenceSource& source,
                            const std::string& sentence, const GenerateOptions& options) {
  FoundEvidence result;
  const auto k = static_cast<int>(generator.max_hits());
  if (!options.use_retrieval || k == 0) return result;
  const std::vector<float> query = generator.sentence_vector(sentence);
  search::FoundClips all = source.find(sentence, query, k, options.evidence);
  result.words = std::move(all.words);
  for (search::FoundClip& found : all.clips) {
    Evidence evidence;
    evidence.hit = found.hit;
    if (found.text.empty()) {
      evidence.use = EvidenceUse::no_captions;
      result.evidence.push_back(std::move(evidence));
      continue;
    }
    RetrievedMotion motion;
    motion.clip_id = found.hit.clip.id;
    motion.probability = found.hit.probability;
    motion.frames = found.hit.clip.frames;
    if (found.hit.as_mirrored) {
      motion.poses = mirror_hit(generator, source, found);
    }
    motion.similarity = cosine(query, found.motion);
    motion.caption_similarity = cosine(query, found.text);
    motion.motion = std::move(found.motion);
    motion.text = std::move(found.text);
    const bool sequence = options.follow > 0 ||
                          static_cast<int64_t>(result.motions.size()) < generator.sequence_hits();
    if (!sequence) {
      motion.poses.reset();
    } else if (!motion.poses) {
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
