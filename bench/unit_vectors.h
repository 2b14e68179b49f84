#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "base/random.h"

namespace remomask {

inline void normalise_row(float* vector, int width) {
  double square = 0;
  for (int i = 0; i < width; ++i) square += static_cast<double>(vector[i]) * vector[i];
  for (int i = 0; i < width; ++i) vector[i] /= static_cast<float>(std::sqrt(square));
}

/// Directions without structure, [count][width], L2-normalised.
inline std::vector<float> random_unit_vectors(int64_t count, int width, uint64_t seed) {
  CounterRandom random(seed);
  std::vector<float> vectors(static_cast<size_t>(count * width));
  for (int64_t row = 0; row < count; ++row) {
    float* vector = vectors.data() + row * width;
    for (int i = 0; i < width; ++i) vector[i] = static_cast<float>(random.uniform(-1, 1));
    normalise_row(vector, width);
  }
  return vectors;
}

/// A mixture that resembles the embeddings of motions: centre (2,000 kinds of
/// motion) plus 0.9 of a random direction. Two of one kind have a cosine of
/// about 0.55, two of different kinds of about 0.
inline std::vector<float> clustered_unit_vectors(int64_t count, int width, uint64_t seed) {
  constexpr int64_t kCentres = 2000;
  constexpr float kNoise = 0.9f;
  const std::vector<float> centres = random_unit_vectors(kCentres, width, 99);
  std::vector<float> vectors = random_unit_vectors(count, width, seed);
  CounterRandom random(mix_seed(seed, 1));
  for (int64_t row = 0; row < count; ++row) {
    const auto kind = static_cast<int64_t>(random.uniform() * kCentres) % kCentres;
    float* vector = vectors.data() + row * width;
    for (int i = 0; i < width; ++i) vector[i] = centres[kind * width + i] + kNoise * vector[i];
    normalise_row(vector, width);
  }
  return vectors;
}

}  // namespace remomask
