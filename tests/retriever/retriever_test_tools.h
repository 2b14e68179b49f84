#pragma once

#include <string>
#include <vector>

#include "db/training_set.h"
#include "retriever/config.h"
#include "retriever/retriever.h"

namespace remomask {

/// Noise of the given length; the same for the same seed.
motion::Features random_features(int frames, uint64_t seed);

/// `kinds` kinds of motion (a constant pattern each, with noise), each with its
/// own words, `repeats` clips a kind; every clip is a group of its own.
std::vector<db::TrainingClip> separable_clips(int kinds, int repeats, uint64_t seed);

/// Preset tiny over tiny_words().
retriever::RetrieverConfig tiny_retriever_config();

/// With random weights.
retriever::Retriever untrained_retriever(uint64_t seed);

}  // namespace remomask
