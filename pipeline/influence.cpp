#include "pipeline/influence.h"

#include <torch/types.h>

namespace remomask::pipeline {

std::vector<double> hit_influence(const Generator& generator, const std::string& prompt,
                                  const std::vector<RetrievedMotion>& hits,
                                  const GenerateOptions& options, const Generated& made,
                                  const Monitor& monitor) {
  const at::Tensor tokens = made.tokens.select(2, 0);
  std::vector<double> result;
  for (int left_out = 0; left_out < made.hits_used; ++left_out) {
    std::vector<RetrievedMotion> others(hits.begin(), hits.begin() + made.hits_used);
    others.erase(others.begin() + left_out);
    // Not generate(): the length of the motion may come from the hits.
    TokenCanvas map = generator.canvas(tokens.size(0));
    generator.fill(map, 0, tokens.size(0), prompt, others, options, nullptr, monitor);
    result.push_back(map.tokens.select(2, 0).ne(tokens).to(torch::kDouble).mean().item<double>());
  }
  return result;
}

}  // namespace remomask::pipeline
