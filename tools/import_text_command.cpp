#include "tools/import_text_command.h"

#include <CLI/CLI.hpp>

#include "tools/core.h"
#include "tools/usage.h"

namespace remomask::tools {

void register_import_text(CLI::App& app, Program& program) {
  auto options = std::make_shared<ImportTextCommand>();
  CLI::App* command = add_command(app, "import-text",
                                  "make a text file of a published sentence encoder (BERT family)",
                                  "remomask import-text all-MiniLM-L6-v2 -o text.safetensors");
  command
      ->add_option("folder", options->folder,
                   "its folder: config.json, vocab.txt, model.safetensors; pooling and lower case "
                   "by their files if they are there")
      ->required();
  command->add_option("-o,--output", options->file, "text file, stored in half precision")
      ->required();
  command
      ->add_option("--max-tokens", options->max_tokens,
                   "word pieces that are read of a text; default: as the folder says, else 256")
      ->check(at_least(3));
  command->add_option("--licence", options->licence,
                      "licence of the weights; default: as the weights say");
  command->callback([options, &program] { core(program).import_text(*options, program); });
}

}  // namespace remomask::tools
