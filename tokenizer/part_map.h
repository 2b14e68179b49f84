#pragma once

#include <ATen/core/Tensor.h>

#include "motion/body_parts.h"

namespace remomask::tokenizer {

inline constexpr int kSlots = motion::kBodyParts * motion::kPartSlots;
inline constexpr int kSlotChannels = 12;

/// Features seen as body parts: every frame becomes 24 slots (six parts of
/// four, see body_parts.h) of 12 channels. The slot of a joint holds its
/// position (3), 6D rotation (6) and velocity (3); joint 0 has a velocity only.
/// The root slot holds yaw velocity, x and z velocity, height (channels 0..3)
/// and the four contacts (4..7). All other channels are zero. No column is
/// dropped: the map and back is the identity.
class PartMap {
 public:
  explicit PartMap(const Skeleton& skeleton);

  /// [..., 12 J - 1] -> [..., 24, 12].
  at::Tensor to_map(const at::Tensor& features) const;
  /// [..., 24, 12] -> [..., 12 J - 1]; what stands in unused channels is ignored.
  at::Tensor to_features(const at::Tensor& map) const;

 private:
  int64_t dim_;
  at::Tensor column_of_cell_;  ///< [288], dim_ (a column of zeros) where unused
  at::Tensor cell_of_column_;  ///< [dim_]
};

}  // namespace remomask::tokenizer
