#include "tokenizer/length_batches.h"

#include <torch/types.h>

#include <map>

namespace remomask::tokenizer {

std::vector<LengthBatch> batches_by_length(const std::vector<const motion::Features*>& clips,
                                           int64_t unit, size_t batch) {
  std::map<int64_t, std::vector<size_t>> by_length;
  for (size_t i = 0; i < clips.size(); ++i) {
    const int64_t frames = clips[i]->frames / unit * unit;
    if (frames > 0) by_length[frames].push_back(i);
  }
  std::vector<LengthBatch> batches;
  for (const auto& [frames, members] : by_length) {
    for (size_t first = 0; first < members.size(); first += batch) {
      const size_t last = std::min(members.size(), first + batch);
      batches.push_back({frames,
                         {members.begin() + static_cast<std::ptrdiff_t>(first),
                          members.begin() + static_cast<std::ptrdiff_t>(last)}});
    }
  }
  return batches;
}

at::Tensor feature_rows(const motion::Features& features, int64_t first, int64_t frames) {
  // from_blob wants a mutable pointer; the clone right after only reads it.
  auto* data = const_cast<float*>(features.row(static_cast<int>(first)));
  return torch::from_blob(data, {frames, features.dim}, torch::kFloat).clone();
}

at::Tensor stack_batch(const std::vector<const motion::Features*>& clips,
                       const LengthBatch& batch) {
  std::vector<at::Tensor> rows;
  for (const size_t member : batch.members) {
    rows.push_back(feature_rows(*clips[member], 0, batch.frames));
  }
  return torch::stack(rows);
}

}  // namespace remomask::tokenizer
