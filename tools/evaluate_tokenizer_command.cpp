#include <fmt/format.h>

#include "generator/tokenizer_metrics.h"
#include "tools/evaluate_command.h"
#include "tools/workspace.h"

namespace remomask {

namespace {

void print_reconstruction(const char* name, const ReconstructionErrors& errors) {
  fmt::print(
      "{:<11} MPJPE {:6.1f} mm   in the world {:6.1f} mm   bone length {:5.1f} mm   foot "
      "skate {:5.2f} mm/frame\n",
      name, errors.mpjpe, errors.global_mpjpe, errors.bone_length, errors.foot_skate);
}

}  // namespace

void register_evaluate_tokenizer(CLI::App& parent, Program& program) {
  auto input = std::make_shared<EvaluationInput>();
  CLI::App* command =
      add_command(parent, "tokenizer", "reconstruction error of the tokenizer, use of its codes",
                  "remomask evaluate tokenizer --db motions.sqlite");
  input->add(*command);
  command->callback([input, &program] {
    const std::string model_path = input->files.model_path();
    TokenizerNetwork network = load_tokenizer_network(load_stage(model_path, "tokenizer"));
    const auto clips = input->load(FeatureMode::fixed);
    const TokenizerMetrics metrics = measure_tokenizer(network, clip_features(clips));
    if (program.json) return program.print_json(input->stamped(metrics, clips));
    fmt::print("split {}: {} clips, {} frames; MPJPE: root of every frame subtracted\n",
               input->split, metrics.clips, metrics.frames);
    print_reconstruction("all levels", metrics.all_levels);
    print_reconstruction("base level", metrics.base_level);
    for (size_t level = 0; level < metrics.code_use.size(); ++level) {
      fmt::print("level {}     {:5.1f} % of the codes used, perplexity {:.0f}\n", level,
                 100 * metrics.code_use[level], metrics.perplexity[level]);
    }
  });
}

}  // namespace remomask
