#pragma once

#include <vector>

#include "nn/tensor_values.h"
#include "pipeline/motion_generator.h"
#include "tests/generator/tiny_model.h"

namespace remomask {

/// Hits of 40 and 60 frames, as vectors only.
inline std::vector<pipeline::RetrievedMotion> two_hits() {
  const training::GeneratorData& data = tiny_model().data;
  std::vector<pipeline::RetrievedMotion> hits;
  for (int64_t i = 0; i < 2; ++i) {
    pipeline::RetrievedMotion hit;
    hit.clip_id = i + 1;
    hit.frames = i == 0 ? 40 : 60;
    hit.similarity = 0.7;
    hit.motion = nn::float_vector(data.motion[i]);
    hit.text = nn::float_vector(data.motion_text[i]);
    hits.push_back(hit);
  }
  return hits;
}

}  // namespace remomask
