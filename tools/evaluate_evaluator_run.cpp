#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "base/counted.h"
#include "evaluation/evaluator_quality.h"
#include "evaluation/retrieval_metrics.h"
#include "evaluation/side_rule.h"
#include "evaluation/tokenizer_metrics.h"
#include "nn/model_file.h"
#include "retriever/retriever.h"
#include "tools/evaluate_input.h"

namespace remomask::tools {

namespace {

void print_quality(const evaluation::EvaluatorQuality& quality) {
  for (const evaluation::EvaluatorSubset& subset : quality.subsets) {
    fmt::print("{} ({}): nearest clip of another group has the content {:.1f} %\n", subset.name,
               counted(static_cast<int64_t>(subset.captions.motions), "clip"),
               100 * subset.content.accuracy);
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

void run_evaluate_evaluator(const EvaluateEvaluatorCommand& command, Program& program) {
  evaluation::GenerationFigureOptions figures;
  if (command.draws) figures.draws = *command.draws;
  if (command.batch) figures.batch = *command.batch;
  const evaluation::Evaluator evaluator =
      evaluation::load_evaluator(command.evaluator.evaluator_path());
  const auto load = [&](const std::string& split) {
    return load_clips(command.input, split, evaluator.feature_mode());
  };
  const auto clips = load(command.input.split);
  auto quality = measure_evaluator(evaluator, clips, load("train"), load("val"), figures);
  const db::Database database(command.input.files.database_path(), db::OpenMode::read_only);
  for (const char* split : {"train", "val", "test"}) {
    quality.sides[split] = evaluation::count_real_sides(database, split);
  }
  if (!program.json) return print_quality(quality);
  nlohmann::json document = quality;
  document["model"] = command.evaluator.evaluator_path();
  document["evaluator"] = evaluator.hash();
  document["split"] = command.input.split;
  document["split_hash"] = evaluation::clip_set_hash(clips);
  document["draws"] = figures.draws;
  document["batch"] = figures.batch;
  program.print_json(document);
}

}  // namespace remomask::tools
