#include "pipeline/candidate_list.h"

#include "base/random.h"

namespace remomask::pipeline {

std::vector<uint64_t> candidate_seeds(uint64_t seed, int count) {
  std::vector<uint64_t> seeds = {seed};
  for (int i = 1; i < count; ++i) seeds.push_back(mix_seed(seed, static_cast<uint64_t>(i)));
  return seeds;
}

}  // namespace remomask::pipeline
