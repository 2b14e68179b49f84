#pragma once

#include <ATen/core/Tensor.h>

#include <vector>

#include "motion/features.h"
#include "remomask/progress.h"
#include "retriever/retriever.h"

namespace remomask::search {

/// Frames [first, last) of a longer motion.
struct MomentWindow {
  int first = 0, last = 0;
  bool operator==(const MomentWindow&) const = default;
};

/// Frames in both windows divided by frames in either; 0 for windows that do not overlap.
double temporal_iou(const MomentWindow& a, const MomentWindow& b);

struct MomentOptions {
  std::vector<int> lengths = {20, 30};  ///< of the windows, frames at 20 fps
  int stride = 5;                       ///< frames between starts, at most the shortest length
  /// A moment ends where its similarity falls this far below the best frame ...
  double margin = 0.2;
  /// ... and below this share of the way from the worst frame to the best.
  double share = 0.7;
};

/// Windows of each length over `frames` frames, with starts 0, stride, 2 stride, ... and one flush
/// with the end. A motion no longer than the longest length is one whole window. Ordered by length,
/// then start, without duplicates. Throws Error for lengths below 4, a stride below 1 or above the
/// shortest length, and motions shorter than 4 frames.
std::vector<MomentWindow> moment_windows(int frames, const MomentOptions& options = {});

/// The vector of each window, [W, E], L2-normalised. A window is a slice of the features. Since
/// these are relative to the body's own heading and position, the slice is what the encoder would
/// see of a clip cut there, and what it saw as a crop in training. Throws Error for windows that do
/// not fit the motion, and Interrupted if stopped.
at::Tensor encode_moments(const retriever::Retriever& retriever, const motion::Features& features,
                          const std::vector<MomentWindow>& windows, const Monitor& monitor = {});

/// A stretch of a motion that a query describes.
struct Moment {
  MomentWindow window;
  double similarity = 0;  ///< mean over its frames
};

/// The similarity of each frame of [0, end of the last window): the mean over the windows that
/// contain it.
std::vector<double> frame_similarities(const std::vector<MomentWindow>& windows,
                                       const std::vector<float>& similarities);

/// Up to `count` moments that do not overlap, best first. The windows are shorter than the moment
/// that is sought, since a window inside the right stretch is as similar as the stretch itself.
/// Start and end are those of the stretch of frames with the largest sum of similarity above a
/// threshold (maximum subarray), which is min(best - margin, worst + share (best - worst)) over the
/// frames that earlier moments did not take. Later moments shorter than the shortest window are
/// dropped. query [E], vectors [W, E] of encode_moments().
std::vector<Moment> best_moments(const at::Tensor& query, const std::vector<MomentWindow>& windows,
                                 const at::Tensor& vectors, size_t count = 1,
                                 const MomentOptions& options = {});

}  // namespace remomask::search
