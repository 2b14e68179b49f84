#pragma once

#include <array>
#include <vector>

#include "motion/body_parts.h"

namespace remomask::motion {

/// Body parts over time: a table of frames x six parts (order of body_parts()).
class PartMask {
 public:
  explicit PartMask(int frames) : cells_(static_cast<size_t>(frames)) {}

  /// Marks parts of frames [first, last); no parts: all six. Throws Error for
  /// frames outside of the table, an empty span and numbers that are not those of a part.
  void add(int first, int last, const std::vector<int>& parts = {});

  int frames() const { return static_cast<int>(cells_.size()); }
  bool has(int frame, int part) const {
    return cells_[static_cast<size_t>(frame)][static_cast<size_t>(part)];
  }
  bool whole(int frame) const;  ///< all six parts
  bool any(int frame) const;
  int count() const;  ///< marked cells

 private:
  std::vector<std::array<bool, kBodyParts>> cells_;
};

/// A maximal stretch of frames [first, last).
struct FrameRun {
  int first = 0, last = 0;
};

/// The stretches in which a part is marked.
std::vector<FrameRun> part_runs(const PartMask& mask, int part);
/// The stretches in which all six parts are marked.
std::vector<FrameRun> whole_runs(const PartMask& mask);

}  // namespace remomask::motion
