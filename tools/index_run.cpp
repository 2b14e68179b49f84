#include <fmt/format.h>

#include "base/counted.h"
#include "encoders/sentence_encoder.h"
#include "index/update_index.h"
#include "nn/model_file.h"
#include "retriever/embed_database.h"
#include "search/embed_captions.h"
#include "tools/generation_run.h"
#include "tools/index_command.h"
#include "tools/index_path.h"

namespace remomask::tools {

namespace {

std::string describe_type(const index::IndexType& type) {
  std::string text = type.factory;
  if (!type.search_parameters.empty()) text += " " + type.search_parameters;
  if (type.requested != type.factory) text += " (" + type.requested + ")";
  return text + (type.recall ? fmt::format(", recall@10 {:.3f}", *type.recall) : ", exact");
}

nlohmann::json update_json(const FileOptions& files, int64_t embedded, int64_t captions,
                           const index::IndexUpdate& made) {
  nlohmann::json document = {{"index", index_path(files)},
                             {"clips", made.count},
                             {"width", made.width},
                             {"factory", made.type.factory},
                             {"requested", made.type.requested},
                             {"search_parameters", made.type.search_parameters},
                             {"recall_at_10", nullptr},
                             {"embedded", embedded},
                             {"captions_embedded", captions},
                             {"added", made.difference.added},
                             {"dropped", made.difference.dropped},
                             {"rebuilt", nullptr}};
  if (made.type.recall) document["recall_at_10"] = *made.type.recall;
  if (!made.rebuilt.empty()) document["rebuilt"] = made.rebuilt;
  return document;
}

}  // namespace

void run_index(const IndexCommand& command, Program& program) {
  const std::string model_path = command.files.model_path();
  const retriever::Retriever retriever =
      retriever::open_retriever(model_path, text_file(command.files));
  db::Database database(command.files.database_path(), db::OpenMode::read_write);
  const Monitor monitor = program.monitor();
  const int64_t embedded = retriever::embed_database(database, retriever, monitor);
  if (command.rebuild) database.drop_unused_caption_vectors("");
  const int64_t captions = search::embed_captions(database, *retriever.words(), monitor);
  index::UpdateOptions update;
  update.rebuild = command.rebuild;
  if (command.factory || command.search_parameters) {
    index::VectorIndexOptions type;
    if (command.factory) type.factory = *command.factory;
    if (command.search_parameters) type.search_parameters = *command.search_parameters;
    update.type = type;
  }
  const index::IndexUpdate made =
      index::update_index(index_path(command.files), database, retriever.hash(), update, monitor);
  program.finish_progress();
  if (program.json) {
    return program.print_json(update_json(command.files, embedded, captions, made));
  }
  fmt::print("{}: {}, {} numbers each, {}\n", index_path(command.files),
             counted(static_cast<int64_t>(made.count), "clip"), made.width,
             describe_type(made.type));
  fmt::print("{} and {} embedded, {} added, {} dropped{}\n", counted(embedded, "clip"),
             counted(captions, "caption"), made.difference.added, made.difference.dropped,
             made.rebuilt.empty() ? "" : "; built anew: " + made.rebuilt);
}

}  // namespace remomask::tools
