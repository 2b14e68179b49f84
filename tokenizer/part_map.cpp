#include "tokenizer/part_map.h"

#include <torch/types.h>

#include <vector>

#include "motion/feature_layout.h"

namespace remomask::tokenizer {

PartMap::PartMap(const Skeleton& skeleton) : dim_(skeleton.feature_dim()) {
  const motion::FeatureLayout layout(skeleton);
  std::vector<int64_t> columns(kSlots * kSlotChannels, dim_), cells(dim_, -1);
  const auto place = [&](int slot, int channel, int64_t first, int count) {
    for (int i = 0; i < count; ++i) {
      const int64_t cell = slot * kSlotChannels + channel + i;
      columns[cell] = first + i;
      cells[first + i] = cell;
    }
  };
  const motion::BodyPartMap& parts = motion::body_parts(skeleton);
  for (int slot = 0; slot < kSlots; ++slot) {
    const int joint = parts.slots[slot / motion::kPartSlots][slot % motion::kPartSlots];
    if (joint == motion::kFreeSlot) continue;
    if (joint == motion::kRootSlot) {
      place(slot, 0, 0, 4);
      place(slot, 4, layout.contacts, 4);
      continue;
    }
    if (joint > 0) {
      place(slot, 0, layout.positions + 3 * (joint - 1), 3);
      place(slot, 3, layout.rotations + 6 * (joint - 1), 6);
    }
    place(slot, 9, layout.velocities + 3 * joint, 3);
  }
  column_of_cell_ = torch::tensor(columns, torch::kLong);
  cell_of_column_ = torch::tensor(cells, torch::kLong);
}

at::Tensor PartMap::to_map(const at::Tensor& features) const {
  auto sizes = features.sizes().vec();
  const auto lead = sizes;
  sizes.back() = 1;
  const auto padded = torch::cat({features, torch::zeros(sizes, features.options())}, -1);
  auto shape = lead;
  shape.back() = kSlots;
  shape.push_back(kSlotChannels);
  return padded.index_select(-1, column_of_cell_.to(features.device())).reshape(shape);
}

at::Tensor PartMap::to_features(const at::Tensor& map) const {
  return map.flatten(-2).index_select(-1, cell_of_column_.to(map.device()));
}

}  // namespace remomask::tokenizer
