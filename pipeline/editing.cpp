#include "pipeline/editing.h"

#include <torch/types.h>

#include <algorithm>

#include "base/time.h"
#include "motion/canonical.h"
#include "motion/features.h"
#include "remomask/error.h"
#include "tokenizer/tokenizer_network.h"

namespace remomask::pipeline {

namespace {

motion::PartMask edit_mask(const Motion& original, const std::vector<CellSpan>& spans,
                           int extend_frames) {
  if (extend_frames < 0) throw Error("a motion cannot be continued by fewer than no frames");
  motion::PartMask mask(original.frames + extend_frames);
  for (const CellSpan& span : spans) {
    if (span.last > original.frames) {
      throw Error("the span of frames " + std::to_string(span.first) + " to " +
                  std::to_string(span.last) + " goes beyond the motion's " +
                  std::to_string(original.frames) + " frames; to continue a motion, extend it");
    }
    mask.add(span.first, span.last, span.parts);
  }
  if (extend_frames > 0) mask.add(original.frames, mask.frames());
  if (mask.count() == 0) throw Error("there is nothing to edit: name a span or an extension");
  return mask;
}

/// Tokens of the whole motion; the last token frame is filled up with its last pose.
at::Tensor encode_whole(const Generator& generator, const Motion& original) {
  const Skeleton& skeleton = generator.skeleton();
  const motion::FeatureMode mode =
      motion::parse_feature_mode(generator.tokenizer().config().feature_mode);
  motion::Features features =
      motion::extract_features_all_frames(motion::canonicalize(original, skeleton), skeleton, mode);
  const std::vector<float> last(features.row(features.frames - 1),
                                features.row(features.frames - 1) + features.dim);
  for (; features.frames % kFramesPerToken != 0; ++features.frames) {
    features.values.insert(features.values.end(), last.begin(), last.end());
  }
  return generator.tokenizer().encode(features);
}

/// Cells no frame of which is to change. A map of one row is the whole body.
at::Tensor unchanged_cells(const motion::PartMask& mask, int64_t frames, int64_t rows) {
  at::Tensor known = torch::ones({frames, rows}, torch::kBool);
  bool* cells = known.data_ptr<bool>();
  for (int t = 0; t < mask.frames(); ++t) {
    for (int64_t row = 0; row < rows; ++row) {
      const bool changes =
          rows == motion::kBodyParts ? mask.has(t, static_cast<int>(row)) : mask.any(t);
      if (changes) cells[t / kFramesPerToken * rows + row] = false;
    }
  }
  return known;
}

}  // namespace

Edited edit_motion(const Generator& generator, const Motion& original,
                   const std::vector<CellSpan>& spans, const std::string& prompt,
                   const std::vector<RetrievedMotion>& hits, const EditOptions& options,
                   const Monitor& monitor) {
  const Skeleton& skeleton = generator.skeleton();
  if (skeleton.name != "humanml3d") {
    throw Error("only models of the skeleton humanml3d can edit, this one is for " + skeleton.name);
  }
  if (original.frames < kFramesPerToken) {
    throw Error("a motion of " + std::to_string(original.frames) +
                " frames is too short to edit; it needs at least 4");
  }
  Edited result;
  result.mask = edit_mask(original, spans, options.extend_frames);
  const at::Tensor tokens = encode_whole(generator, original);
  TokenCanvas canvas =
      generator.canvas((result.mask.frames() + kFramesPerToken - 1) / kFramesPerToken);
  canvas.tokens.slice(0, 0, tokens.size(0)).copy_(tokens);
  canvas.known = unchanged_cells(result.mask, canvas.tokens.size(0), canvas.tokens.size(1));
  result.tokens = canvas.known.numel();
  result.tokens_sampled = result.tokens - canvas.known.sum().item<int64_t>();

  const at::Tensor changed = canvas.known.all(1).logical_not().nonzero().reshape({-1});
  const FillReport filled =
      generator.fill(canvas, changed[0].item<int64_t>(), changed[-1].item<int64_t>() + 1, prompt,
                     hits, options, &result.times, monitor);
  result.hits_used = filled.hits_used;
  result.followed = filled.followed;
  const Motion made =
      slice(generator.decode(canvas.tokens, options.held_feet), 0, result.mask.frames());
  result.motion = kinematics::splice_motion(original, made, result.mask, skeleton,
                                            {.fade = options.fade}, &result.splice);
  return result;
}

}  // namespace remomask::pipeline
