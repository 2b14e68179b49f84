#include "tools/evaluate_command.h"

#include <CLI/CLI.hpp>

#include "tools/core.h"
#include "tools/usage.h"

namespace remomask::tools {

namespace {

void add_resamples(CLI::App& command, std::optional<int>& resamples) {
  command.add_option("--resamples", resamples, "of the intervals; 0: no intervals")
      ->check(number_between(0, 1e6));
}

void register_retrieval(CLI::App& parent, Program& program) {
  auto options = std::make_shared<EvaluateRetrievalCommand>();
  CLI::App* command =
      add_command(parent, "retrieval", "recall and median rank of search by text and by motion",
                  "remomask evaluate retrieval --db motions.sqlite --protocol duplicates");
  options->input.add(*command);
  command
      ->add_option("--protocol", options->protocols,
                   "all, threshold, dissimilar, small-batch or duplicates (repeatable, or a list "
                   "with commas; default: each)")
      ->delimiter(',');
  command
      ->add_option("--threshold", options->threshold,
                   "captions as alike as this are the same in the protocol threshold")
      ->check(number_between(0.5, 1.0));
  add_resamples(*command, options->resamples);
  command->add_flag("--all-captions", options->all_captions, "every caption, not the first alone");
  command->callback([options, &program] { core(program).evaluate_retrieval(*options, program); });
}

void register_calibration(CLI::App& parent, Program& program) {
  auto options = std::make_shared<EvaluateCalibrationCommand>();
  CLI::App* command =
      add_command(parent, "calibration", "what share of the hits at a similarity is right",
                  "remomask evaluate calibration --db motions.sqlite --store");
  options->input.add(*command);
  command->add_option("--check", options->check, "split that the calibration is checked on")
      ->capture_default_str();
  command->add_flag("--store", options->store, "keep the calibration in the database");
  command->add_option("--plot", options->plot, "reliability diagram (.png)");
  command->callback([options, &program] { core(program).evaluate_calibration(*options, program); });
}

void register_moments(CLI::App& parent, Program& program) {
  auto options = std::make_shared<EvaluateMomentsCommand>();
  CLI::App* command = add_command(parent, "moments",
                                  "does search find where in a long motion its sentence happens?",
                                  "remomask evaluate moments --db motions.sqlite --tasks 300");
  options->input.add(*command);
  command->add_option("--tasks", options->tasks, "long motions, each of three clips joined");
  command->add_option("--seed", options->seed, "choice of the clips");
  command->add_option("--windows", options->windows, "lengths of the windows, frames at 20 fps")
      ->delimiter(',');
  command->add_option("--stride", options->stride, "frames between windows");
  command->add_option("--margin", options->margin,
                      "minimum by which the similarity of frames outside a moment falls short");
  command
      ->add_option("--share", options->share,
                   "of the way from the worst frame to the best, where a moment ends")
      ->check(number_between(0.0, 1.0));
  add_resamples(*command, options->resamples);
  command->callback([options, &program] { core(program).evaluate_moments(*options, program); });
}

void register_queries(CLI::App& parent, Program& program) {
  auto options = std::make_shared<EvaluateQueriesCommand>();
  CLI::App* command = add_command(parent, "queries",
                                  "how search copes with other wordings, and what part vectors add",
                                  "remomask evaluate queries --db motions.sqlite --split val");
  options->input.add(*command);
  add_resamples(*command, options->resamples);
  command->callback([options, &program] { core(program).evaluate_queries(*options, program); });
}

void register_search_prompts(CLI::App& parent, Program& program) {
  auto options = std::make_shared<EvaluateSearchCommand>();
  CLI::App* command =
      add_command(parent, "search", "does search find what people ask for in their own words?",
                  "remomask evaluate search --db motions.sqlite --prompts prompts.jsonl");
  options->files.add_model(*command);
  options->files.add_database(*command);
  options->filter.add(*command);
  command
      ->add_option("--prompts", options->prompts,
                   "JSON Lines of {\"prompt\": \"...\", \"labels\": {\"actions\": [\"wave\"]}}; "
                   "labels null: nothing answers it")
      ->required();
  command->add_flag("--fit", options->fit,
                    "fit the score of search to these prompts and store it in the text file");
  command->add_option("--plot", options->plot, "reliability diagram of the probabilities (.png)");
  add_resamples(*command, options->resamples);
  command->callback([options, &program] { core(program).evaluate_search(*options, program); });
}

void register_evaluator(CLI::App& parent, Program& program) {
  auto options = std::make_shared<EvaluateEvaluatorCommand>();
  CLI::App* command = add_command(parent, "evaluator",
                                  "how far the text-motion evaluator can be trusted, on real clips",
                                  "remomask evaluate evaluator --db motions.sqlite");
  options->input.add_clips(*command);
  options->evaluator.add(*command);
  command->add_option("--draws", options->draws, "draws of captions and batches")
      ->check(at_least(1));
  command->add_option("--batch", options->batch, "pairs among which the right one is found")
      ->check(number_between(2, 1000));
  command->callback([options, &program] { core(program).evaluate_evaluator(*options, program); });
}

void register_tokenizer(CLI::App& parent, Program& program) {
  auto options = std::make_shared<EvaluateTokenizerCommand>();
  CLI::App* command =
      add_command(parent, "tokenizer", "reconstruction error of the tokenizer, use of its codes",
                  "remomask evaluate tokenizer --db motions.sqlite");
  options->input.add(*command);
  command->add_option("--evaluator", options->evaluator.path,
                      "also measure the reconstruction FID with this evaluator");
  command->callback([options, &program] { core(program).evaluate_tokenizer(*options, program); });
}

void register_generation(CLI::App& parent, Program& program) {
  auto options = std::make_shared<EvaluateGenerationCommand>();
  CLI::App* command = add_command(
      parent, "generation",
      "generated motions beside real ones: FID, R-precision, content, sides, physics",
      "remomask evaluate generation --db motions.sqlite --prompts 200 --results outcomes.jsonl");
  options->files.add_model(*command);
  options->files.add_database(*command);
  options->evaluator.add(*command);
  options->generation.add(*command);
  command
      ->add_option("--prompts", options->prompts,
                   "number of prompts; 0: every clip of the split once")
      ->capture_default_str()
      ->check(at_least(0));
  command->add_option("--split", options->prompt_split, "captions of these clips")
      ->capture_default_str();
  command
      ->add_option("--draw", options->draw,
                   "even: prompts spread over the contents; uniform: every clip equally likely")
      ->capture_default_str()
      ->check(CLI::IsMember({"even", "uniform"}));
  command->add_option("--prompt-seed", options->prompt_seed, "choice of the prompts")
      ->capture_default_str();
  command->add_option("--repeats", options->repeats, "generations of every prompt (papers: 20)")
      ->capture_default_str()
      ->check(at_least(1));
  command
      ->add_option("--modality-prompts", options->modality_prompts,
                   "prompts with 30 more generations, for MultiModality (papers: 96)")
      ->capture_default_str()
      ->check(at_least(0));
  command->add_option("--judge", options->judge, "space in which the nearest real motion is found")
      ->capture_default_str()
      ->check(CLI::IsMember({"evaluator", "retriever"}));
  command
      ->add_option("--results", options->results,
                   "JSON Lines, one motion a line; an existing file is continued")
      ->required();
  command->callback([options, &program] { core(program).evaluate_generation(*options, program); });
}

}  // namespace

void register_evaluate(CLI::App& app, Program& program) {
  CLI::App* command = add_command(app, "evaluate", "measure a model on a split of a database",
                                  "remomask evaluate retrieval --db motions.sqlite");
  command->require_subcommand(1);
  register_retrieval(*command, program);
  register_calibration(*command, program);
  register_moments(*command, program);
  register_queries(*command, program);
  register_search_prompts(*command, program);
  register_evaluator(*command, program);
  register_tokenizer(*command, program);
  register_generation(*command, program);
}

}  // namespace remomask::tools
