#include <fmt/format.h>

#include "encoders/bert_import.h"
#include "encoders/sentence_encoder.h"
#include "tools/import_text_command.h"

namespace remomask::tools {

void run_import_text(const ImportTextCommand& command, Program& program) {
  encoders::BertImportOptions options;
  options.max_tokens = command.max_tokens;
  options.licence = command.licence;
  const nn::ModelStage stage = encoders::import_bert(command.folder, options);
  nn::save_model(command.file, {stage}, /*half=*/true);
  const auto encoder = encoders::SentenceEncoder::open(command.file);
  const auto licence = stage.config.at("licence").get<std::string>();
  if (program.json) {
    return program.print_json({{"file", command.file},
                               {"hash", encoder.hash()},
                               {"width", encoder.width()},
                               {"max_tokens", encoder.max_tokens()},
                               {"licence", licence}});
  }
  fmt::print("{}: {} numbers a text, at most {} word pieces, licence {}\n", command.file,
             encoder.width(), encoder.max_tokens(), licence);
}

}  // namespace remomask::tools
