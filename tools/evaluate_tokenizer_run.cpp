#include <fmt/format.h>

#include "base/counted.h"
#include "evaluation/reconstruction_fid.h"
#include "evaluation/tokenizer_metrics.h"
#include "nn/model_file.h"
#include "retriever/retriever.h"
#include "tools/evaluate_input.h"

namespace remomask::tools {

namespace {

void print_reconstruction(const char* name, const evaluation::ReconstructionErrors& errors) {
  fmt::print(
      "{:<11} MPJPE {:6.1f} mm   in the world {:6.1f} mm   bone length {:5.1f} mm   foot "
      "skate {:5.2f} mm/frame\n",
      name, errors.mpjpe, errors.global_mpjpe, errors.bone_length, errors.foot_skate);
}

}  // namespace

void run_evaluate_tokenizer(const EvaluateTokenizerCommand& command, Program& program) {
  const std::string model_path = command.input.files.model_path();
  const nn::ModelStage stage = nn::load_stage(model_path, "tokenizer");
  tokenizer::TokenizerNetwork network = tokenizer::load_tokenizer_network(stage);
  const auto clips = load_clips(command.input, command.input.split, motion::FeatureMode::fixed);
  const evaluation::TokenizerMetrics metrics =
      evaluation::measure_tokenizer(network, evaluation::clip_features(clips));
  std::optional<evaluation::ReconstructionFid> fid;
  nlohmann::json document = metrics;
  if (!command.evaluator.path.empty()) {
    const evaluation::Evaluator evaluator =
        evaluation::load_evaluator(command.evaluator.evaluator_path());
    fid = measure_reconstruction_fid(evaluator, tokenizer::Tokenizer(stage),
                                     evaluation::clip_features(clips));
    document["fid"] = *fid;
    document["evaluator"] = evaluator.hash();
  }
  if (program.json) return program.print_json(stamped(command.input, document, clips));
  fmt::print("split {}: {}, {}; MPJPE: root of every frame subtracted\n", command.input.split,
             counted(static_cast<int64_t>(metrics.clips), "clip"),
             counted(static_cast<int64_t>(metrics.frames), "frame"));
  print_reconstruction("all levels", metrics.all_levels);
  print_reconstruction("base level", metrics.base_level);
  if (fid) {
    fmt::print("FID         all levels {:.4f}   base level {:.4f}\n", fid->all_levels,
               fid->base_level);
  }
  for (size_t level = 0; level < metrics.code_use.size(); ++level) {
    fmt::print("level {}     {:5.1f} % of the codes used, perplexity {:.0f}\n", level,
               100 * metrics.code_use[level], metrics.perplexity[level]);
  }
}

}  // namespace remomask::tools
