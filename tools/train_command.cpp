#include "tools/train_command.h"

#include <CLI/CLI.hpp>

#include "base/preset.h"
#include "tools/core.h"
#include "tools/usage.h"

namespace remomask::tools {

void register_train(CLI::App& app, Program& program) {
  auto options = std::make_shared<TrainCommand>();
  CLI::App* command =
      add_command(app, "train", "train one network or all; the same command resumes",
                  "remomask train all --db motions.sqlite --preset base -o run");
  command
      ->add_option("stage", options->stage,
                   "retriever, tokenizer, masked, residual, all (of these), evaluator, words (an "
                   "adapter of the sentence encoder)")
      ->required()
      ->check(CLI::IsMember(
          {"retriever", "tokenizer", "masked", "residual", "all", "evaluator", "words"}));
  command->add_option("--db", options->database, "database with splits train and val")->required();
  command->add_option("-o,--output", options->folder, "folder of the stage files")->required();
  command->add_option("--preset", options->preset, "sizes of all networks")
      ->capture_default_str()
      ->check(CLI::IsMember(preset_names()));
  command
      ->add_option("--variant", options->variant,
                   "leave something out, for comparisons: full, momask, no-retrieval, no-ssta, ... "
                   "(docs/training.md lists them), levels-N, quantizer-dropout-PERCENT")
      ->capture_default_str();
  command->add_option("--source", options->sources, "only these data sets (repeatable)");
  command
      ->add_option("--text", options->text_file,
                   "text file of the sentence encoder that the model reads sentences with, copied "
                   "into the folder (words: that is adapted); default: the shipped one")
      ->check(CLI::ExistingFile);
  command
      ->add_option("--tune-text-layers", options->tuned_text_layers,
                   "retriever: last layers of the sentence encoder to train in a copy of its own")
      ->capture_default_str()
      ->check(at_least(0));
  CLI::Option* start =
      command
          ->add_option("--from", options->start,
                       "go on from the weights of this model, where their shapes fit")
          ->check(CLI::ExistingFile);
  command->add_option("--keep", options->kept, "with --from: stages that are taken as they are")
      ->needs(start)
      ->delimiter(',')
      ->check(CLI::IsMember({"retriever", "tokenizer", "masked", "residual"}));
  command->add_option("--steps", options->steps, "steps; default: of the preset")
      ->check(at_least(1));
  command->add_option("--batch", options->batch, "clips a step; default: of the preset")
      ->check(at_least(1));
  command->add_option("--rate", options->learning_rate, "learning rate; default: of the preset")
      ->check(positive_number());
  command->add_option("--seed", options->seed, "of weights, order and masks")
      ->capture_default_str();
  command->add_option("--queues", options->queues, "negatives of the retriever besides the batch")
      ->capture_default_str()
      ->check(CLI::IsMember({"none", "motion", "text", "both"}));
  command
      ->add_option("--queue-size", options->queue_size,
                   "entries of each queue; default: of the "
                   "preset")
      ->check(at_least(1));
  command
      ->add_option("--same-label-weight", options->same_label_weight,
                   "retriever: weight of clips with equal labels content and style as negatives of "
                   "each other; default: of the preset")
      ->check(number_between(0.0, 1.0));
  command->callback([options, &program] { core(program).train(*options, program); });
}

}  // namespace remomask::tools
