#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "evaluation/evaluator_quality.h"
#include "evaluation/side_rule.h"
#include "evaluation/tokenizer_metrics.h"
#include "tools/evaluate_command.h"

namespace remomask::tools {

namespace {

struct EvaluateEvaluatorOptions : EvaluationInput {
  EvaluatorOption evaluator;
  evaluation::GenerationFigureOptions figures;
};

void print_quality(const evaluation::EvaluatorQuality& quality) {
  for (const evaluation::EvaluatorSubset& subset : quality.subsets) {
    fmt::print("{} ({} clips): nearest clip of another group has the content {:.1f} %\n",
               subset.name, subset.captions.motions, 100 * subset.content.accuracy);
    for (const auto& [name, figures] :
         {std::pair<const char*, const evaluation::GenerationFigures&>{"distinct captions",
                                                                       subset.captions},
          {"distinct labels", subset.labels}}) {
      const auto& top = figures.r_precision;
      if (std::isnan(top[0].mean)) {
        fmt::print("  {:<18} no full batch\n", name);
        continue;
      }
      fmt::print(
          "  {:<18} R-precision {:.3f} +-{:.3f} / {:.3f} +-{:.3f} / {:.3f} +-{:.3f}   MM-Dist "
          "{:.3f}   Diversity {:.3f}   {} ranked\n",
          name, top[0].mean, top[0].interval, top[1].mean, top[1].interval, top[2].mean,
          top[2].interval, figures.mm_dist.mean, figures.diversity.mean, figures.ranked);
    }
  }
  fmt::print("FID of the split to the training clips: {:.3f}\n", quality.fid_to_train);
  for (const auto& [split, counts] : quality.sides) {
    fmt::print("side rule on real clips of {}: hands {} of {}, turns {} of {}\n", split,
               counts.hands.right, counts.hands.asked, counts.turns.right, counts.turns.asked);
  }
}

}  // namespace

void register_evaluate_evaluator(CLI::App& parent, Program& program) {
  auto options = std::make_shared<EvaluateEvaluatorOptions>();
  CLI::App* command = add_command(parent, "evaluator",
                                  "how far the text-motion evaluator can be trusted, on real clips",
                                  "remomask evaluate evaluator --db motions.sqlite");
  options->add_clips(*command);
  options->evaluator.add(*command);
  command->add_option("--draws", options->figures.draws, "draws of captions and batches")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--batch", options->figures.batch, "pairs among which the right one is found")
      ->capture_default_str()
      ->check(CLI::Range(2, 1000));
  command->callback([options, &program] {
    const evaluation::Evaluator evaluator = options->evaluator.load();
    const auto clips = options->load(evaluator.feature_mode());
    auto quality =
        measure_evaluator(evaluator, clips, options->load("train", evaluator.feature_mode()),
                          options->load("val", evaluator.feature_mode()), options->figures);
    const db::Database database(options->files.database_path(), db::OpenMode::read_only);
    for (const char* split : {"train", "val", "test"}) {
      quality.sides[split] = evaluation::count_real_sides(database, split);
    }
    if (!program.json) return print_quality(quality);
    nlohmann::json document = quality;
    document["model"] = options->evaluator.evaluator_path();
    document["evaluator"] = evaluator.hash();
    document["split"] = options->split;
    document["split_hash"] = evaluation::clip_set_hash(clips);
    document["draws"] = options->figures.draws;
    document["batch"] = options->figures.batch;
    program.print_json(document);
  });
}

}  // namespace remomask::tools
