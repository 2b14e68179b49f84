#include "tools/generation_run.h"

#include <fmt/format.h>

#include "base/counted.h"
#include "encoders/text_file.h"
#include "remomask/error.h"
#include "search/word_model.h"

namespace remomask::tools {

TextToMotion open_model(const FileOptions& files, const Program& program, bool retrieval) {
  OpenOptions open;
  open.index = files.index;
  open.text = files.text;
  open.threads = program.threads;
  open.retrieval = retrieval;
  return TextToMotion(files.model_path(), files.database_path(), open);
}

std::string text_file(const FileOptions& files) {
  return files.text.empty() ? encoders::text_file_of(files.model_path()) : files.text;
}

void stop_after(int done, int count, uint64_t seed) {
  throw Interrupted(
      fmt::format("stopped; {} of {} are stored; --seed {} --count {} makes the others", done,
                  counted(count, "motion"), seed, count - done));
}

nlohmann::json answer_entry(nlohmann::json document, const std::string& path, double seconds) {
  document["file"] = path;
  document["seconds_of_work"] = seconds;
  return document;
}

void print_motions(Program& program, nlohmann::json motions) {
  program.print_json({{"schema", "remomask.motions/1"}, {"motions", std::move(motions)}});
}

void finish_sheet(const std::string& path, const std::vector<drawing::SheetRow>& rows,
                  const Program& program) {
  if (path.empty()) return;
  drawing::write_contact_sheet(path, rows);
  if (!program.json) fmt::print("{}: contact sheet\n", path);
}

}  // namespace remomask::tools
