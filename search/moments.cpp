#include "search/moments.h"

#include <torch/utils.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "nn/tensor_values.h"
#include "remomask/error.h"

namespace remomask::search {

namespace {

constexpr int kShortestMoment = 4;  // of the encoder
constexpr size_t kMomentBatch = 64;

motion::Features feature_slice(const motion::Features& features, const MomentWindow& window) {
  motion::Features part(window.last - window.first, features.dim);
  std::copy(features.row(window.first), features.row(window.first) + part.values.size(),
            part.values.begin());
  return part;
}

/// Frames taken by a moment.
constexpr double kTaken = -std::numeric_limits<double>::infinity();

double moment_threshold(const std::vector<double>& curve, const MomentOptions& options) {
  double best = kTaken, worst = -kTaken;
  for (const double value : curve) {
    if (value == kTaken) continue;
    best = std::max(best, value);
    worst = std::min(worst, value);
  }
  return std::min(best - options.margin, worst + options.share * (best - worst));
}

/// The frames with the greatest sum above the threshold (Kadane); the first of
/// equal ones. The curve has a frame that is not taken.
MomentWindow greatest_stretch(const std::vector<double>& curve, double threshold) {
  MomentWindow best;
  double most = kTaken, sum = 0;
  int first = 0;
  for (int t = 0; t < static_cast<int>(curve.size()); ++t) {
    if (sum <= 0) {
      sum = 0;
      first = t;
    }
    sum += curve[static_cast<size_t>(t)] - threshold;
    if (sum > most) {
      most = sum;
      best = {first, t + 1};
    }
  }
  return best;
}

}  // namespace

double temporal_iou(const MomentWindow& a, const MomentWindow& b) {
  const int both = std::min(a.last, b.last) - std::max(a.first, b.first);
  if (both <= 0) return 0;
  return static_cast<double>(both) / (a.last - a.first + b.last - b.first - both);
}

std::vector<MomentWindow> moment_windows(int frames, const MomentOptions& options) {
  const auto shortest = std::min_element(options.lengths.begin(), options.lengths.end());
  if (shortest == options.lengths.end() || *shortest < kShortestMoment || options.stride < 1 ||
      options.stride > *shortest) {
    throw Error(
        "moments need window lengths of at least 4 frames and a stride from 1 to the shortest");
  }
  if (frames < kShortestMoment) {
    throw Error("a motion of " + std::to_string(frames) +
                " frames is too short to be searched for moments; it needs at least 4");
  }
  std::vector<int> lengths = options.lengths;
  std::sort(lengths.begin(), lengths.end());
  if (frames <= lengths.back()) lengths.push_back(frames);
  std::sort(lengths.begin(), lengths.end());
  lengths.erase(std::unique(lengths.begin(), lengths.end()), lengths.end());
  std::vector<MomentWindow> windows;
  for (const int length : lengths) {
    if (length > frames) break;
    for (int first = 0; first < frames - length; first += options.stride) {
      windows.push_back({first, first + length});
    }
    windows.push_back({frames - length, frames});
  }
  return windows;
}

at::Tensor encode_moments(const retriever::Retriever& retriever, const motion::Features& features,
                          const std::vector<MomentWindow>& windows, const Monitor& monitor) {
  for (const MomentWindow& window : windows) {
    if (window.first < 0 || window.last > features.frames || window.first >= window.last) {
      throw Error("the moment from frame " + std::to_string(window.first) + " to " +
                  std::to_string(window.last) + " does not lie in a motion of " +
                  std::to_string(features.frames) + " frames");
    }
  }
  std::vector<at::Tensor> vectors = {torch::zeros({0, retriever.embedding_width()})};
  for (size_t first = 0; first < windows.size(); first += kMomentBatch) {
    if (monitor.stop_requested()) throw Interrupted("the search for moments was stopped");
    std::vector<motion::Features> slices;
    for (size_t w = first; w < std::min(windows.size(), first + kMomentBatch); ++w) {
      slices.push_back(feature_slice(features, windows[w]));
    }
    std::vector<const motion::Features*> chosen;
    for (const motion::Features& slice : slices) chosen.push_back(&slice);
    vectors.push_back(retriever.encode_motion(chosen).global);
    monitor.report({"embed moments", static_cast<double>(first + chosen.size()),
                    static_cast<double>(windows.size()), ""});
  }
  return torch::cat(vectors);
}

std::vector<double> frame_similarities(const std::vector<MomentWindow>& windows,
                                       const std::vector<float>& similarities) {
  int frames = 0;
  for (const MomentWindow& window : windows) frames = std::max(frames, window.last);
  std::vector<double> sums(static_cast<size_t>(frames)), counts(static_cast<size_t>(frames));
  for (size_t w = 0; w < windows.size(); ++w) {
    for (int t = windows[w].first; t < windows[w].last; ++t) {
      sums[static_cast<size_t>(t)] += similarities[w];
      counts[static_cast<size_t>(t)] += 1;
    }
  }
  for (size_t t = 0; t < sums.size(); ++t) sums[t] /= std::max(1.0, counts[t]);
  return sums;
}

std::vector<Moment> best_moments(const at::Tensor& query, const std::vector<MomentWindow>& windows,
                                 const at::Tensor& vectors, size_t count,
                                 const MomentOptions& options) {
  if (vectors.size(0) != static_cast<int64_t>(windows.size())) {
    throw Error("each moment needs its own vector");
  }
  if (windows.empty()) return {};
  const at::Tensor cosines = torch::mv(vectors, query);
  if (!torch::isfinite(cosines).all().item<bool>()) {
    throw Error("the similarities are not finite; the retriever is broken, train it again");
  }
  const std::vector<double> similarity = frame_similarities(windows, nn::float_vector(cosines));
  const int shortest = *std::min_element(options.lengths.begin(), options.lengths.end());
  std::vector<double> curve = similarity;
  std::vector<Moment> moments;
  while (moments.size() < count &&
         std::any_of(curve.begin(), curve.end(), [](double value) { return value != kTaken; })) {
    const MomentWindow found = greatest_stretch(curve, moment_threshold(curve, options));
    const auto first = curve.begin() + found.first, last = curve.begin() + found.last;
    if (moments.empty() || found.last - found.first >= shortest) {
      moments.push_back({found, std::accumulate(first, last, 0.0) / (found.last - found.first)});
    }
    std::fill(first, last, kTaken);
  }
  return moments;
}

}  // namespace remomask::search
