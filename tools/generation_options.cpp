#include "tools/generation_options.h"
#include "tools/usage.h"

#include <CLI/CLI.hpp>

#include "remomask/error.h"

namespace remomask::tools {

namespace {

LengthRule length_rule(const std::string& name) {
  if (name == "likely") return LengthRule::likely;
  if (name == "sample") return LengthRule::sample;
  return LengthRule::evidence;
}

}  // namespace

void GenerationOptions::add(CLI::App& command) {
  SamplingOptions& sampling = generate.sampling;
  command.add_option("--steps", sampling.steps, "passes of the masked transformer")
      ->capture_default_str()
      ->check(number_between(1, 1000));
  command
      .add_option("--guidance", sampling.guidance,
                  "w of un + w (con - un); 1: none; the papers' scale is w - 1")
      ->capture_default_str();
  command.add_option("--temperature", sampling.temperature, "0: always the likeliest code")
      ->capture_default_str()
      ->check(at_least(0));
  command.add_option("--top", sampling.top_share, "share of the codes that can be sampled")
      ->capture_default_str()
      ->check(number_between(0.0, 1.0));
  command
      .add_option("--correction-rounds", sampling.correction_rounds,
                  "passes that draw the least likely tenth again")
      ->capture_default_str()
      ->check(at_least(0));
  command.add_option("--residual-guidance", sampling.residual_guidance, "of the detail levels")
      ->capture_default_str();
  command
      .add_option("--residual-temperature", sampling.residual_temperature, "of the detail levels")
      ->capture_default_str()
      ->check(at_least(0));
  command.add_flag("--no-retrieval", no_retrieval, "from the text alone");
  command.add_flag("--read-untrusted", generate.read_untrusted,
                   "read retrieved motions even where none fits the sentence well");
  command
      .add_option("--follow", generate.follow,
                  "share of the frames that keep the codes of a retrieved motion, less where it "
                  "fits less; 0: none, 1: that motion as it is")
      ->capture_default_str()
      ->check(number_between(0.0, 1.0));
  command.add_flag("!--slide", generate.held_feet,
                   "leave the feet as the model made them: do not hold standing ones in place, "
                   "do not raise swinging ones off the floor");
  command
      .add_option("--best-of", generate.best_of,
                  "make so many candidates, keep the one that fits the sentence best and moves "
                  "like a body")
      ->capture_default_str()
      ->check(number_between(1, 100));
}

GenerateOptions GenerationOptions::chosen() const {
  GenerateOptions result = generate;
  result.use_retrieval = !no_retrieval;
  result.length = length_rule(length);
  return result;
}

bool needs_search(const GenerationOptions& options) {
  return !options.no_retrieval || length_rule(options.length) != LengthRule::evidence;
}

}  // namespace remomask::tools
