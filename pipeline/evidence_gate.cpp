#include "pipeline/evidence_gate.h"

#include <algorithm>

namespace remomask::pipeline {

double SimilarityGate::trust(double similarity) const {
  if (similarity >= all) return 1;
  if (similarity <= none) return 0;
  return (similarity - none) / (all - none);
}

double EvidenceGate::trust(double motion_similarity, double caption_similarity) const {
  return std::max(motion.trust(motion_similarity), caption.trust(caption_similarity));
}

}  // namespace remomask::pipeline
