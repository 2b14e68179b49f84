#include "tools/generate_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/core.h"

#include "formats/animation_formats.h"
#include "formats/motion_writing.h"
#include "remomask/error.h"
#include "text/caption.h"
#include "tools/output_path.h"
#include "tools/usage.h"

namespace remomask::tools {

namespace {

void check_prompt_or_script(const std::string& prompt, const std::string& script,
                            const GenerationOptions& generation, int count) {
  if (script.empty()) return;
  if (!prompt.empty()) throw Error("give a sentence or a --script, not both");
  if (count != 1 || generation.generate.seconds) {
    throw Error(
        "--count and --seconds are for one sentence; a script says its seconds "
        "line by line");
  }
}

}  // namespace

void register_generate(CLI::App& app, Program& program) {
  auto options = std::make_shared<GenerateCommand>();
  CLI::App* command =
      add_command(app, "generate", "a sentence in, a motion file out, with its evidence",
                  "remomask generate \"someone does jumping jacks\" -o motion.bvh");
  const CLI::Option* prompt =
      command->add_option("prompt", options->prompt, "what the person does");
  command->add_option("--script", options->script,
                      "several sentences in a row, instead of the prompt: a file with a line "
                      "\"SECONDS  sentence\" each");
  options->add_output(*command);
  command->add_option("--sheet", options->sheet, "also draw a contact sheet (.png)");
  command->add_option("--seconds", options->generation.generate.seconds,
                      "length, 1 to 600, kept to the frame (20 a second); default: see --length");
  command
      ->add_option("--length", options->generation.length,
                   "without --seconds: the median of the retrieved motions (evidence), the "
                   "likeliest length of motions like the sentence (likely), or one drawn by the "
                   "seed (sample)")
      ->capture_default_str()
      ->check(CLI::IsMember({"evidence", "likely", "sample"}));
  options->add_count(*command);
  command->add_flag("--one-file", options->one_file,
                    "with -n: all motions as animations of one .glb or .fbx file");
  command->add_flag("--influence", options->generation.generate.influence,
                    "also say what share of the codes would be others without each retrieved "
                    "motion (as many generations more)");
  options->add_rest(*command);
  command->callback([options, prompt, &program] {
    if (prompt->count() == 0 && options->script.empty()) {
      throw CLI::RequiredError("a sentence, or --script");
    }
    require_writable_output(options->output);
    if (options->one_file) {
      formats::require_room_for_several(options->output);
      if (!options->writing.chosen(options->output).character.empty()) {
        throw Error("--one-file and --character do not go together; leave out one of them");
      }
    }
    options->writing.chosen(options->output);
    check_prompt_or_script(options->prompt, options->script, options->generation, options->count);
    if (options->prompt.size() > text::kMostCaptionBytes) {
      program.warn(fmt::format("only the first {} characters of the prompt can be read",
                               text::kMostCaptionBytes));
    }
    core(program).generate(*options, program);
  });
}

}  // namespace remomask::tools
