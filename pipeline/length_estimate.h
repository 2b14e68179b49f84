#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "remomask/generation.h"

namespace remomask::pipeline {

/// "evidence", "likely" or "sample".
const char* length_rule_name(LengthRule rule);

/// A clip near to a sentence.
struct LengthNeighbour {
  double likeness = 0;  ///< probability that the clip shows what the sentence asks for
  int frames = 0;       ///< at 20 fps; 0: unknown, passed over
};

/// Neighbours that the distribution is made from.
constexpr int kLengthNeighbours = 32;

/// Probabilities of the lengths 0 .. 49 in token frames (0.2 s), estimated by
/// neighbours without training: each counts exp((likeness - the best one's) /
/// 0.1) and spreads it over its own length and two on either side by a
/// triangular kernel. Lengths below 1 s are impossible, longer clips than 9.8 s count as 9.8
/// s. Without neighbours of known length all possible lengths are equally likely.
std::vector<double> length_distribution(const std::vector<LengthNeighbour>& neighbours);

/// Seconds by the rule `likely` (the shortest of equally likely ones) or `sample`.
double estimate_seconds(const std::vector<double>& distribution, LengthRule rule, uint64_t seed);

}  // namespace remomask::pipeline
