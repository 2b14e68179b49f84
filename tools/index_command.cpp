#include <fmt/format.h>

#include "index/update_index.h"
#include "retriever/embed_database.h"
#include "tools/program.h"
#include "tools/workspace.h"

namespace remomask::tools {

namespace {

std::string describe_type(const index::IndexType& type) {
  std::string text = type.factory;
  if (!type.search_parameters.empty()) text += " " + type.search_parameters;
  if (type.requested != type.factory) text += " (" + type.requested + ")";
  return text + (type.recall ? fmt::format(", recall@10 {:.3f}", *type.recall) : ", exact");
}

nlohmann::json update_json(const FileOptions& files, int64_t embedded,
                           const index::IndexUpdate& made) {
  nlohmann::json document = {{"index", files.index_path()},
                             {"clips", made.count},
                             {"width", made.width},
                             {"factory", made.type.factory},
                             {"requested", made.type.requested},
                             {"search_parameters", made.type.search_parameters},
                             {"recall_at_10", nullptr},
                             {"embedded", embedded},
                             {"added", made.difference.added},
                             {"dropped", made.difference.dropped},
                             {"rebuilt", nullptr}};
  if (made.type.recall) document["recall_at_10"] = *made.type.recall;
  if (!made.rebuilt.empty()) document["rebuilt"] = made.rebuilt;
  return document;
}

}  // namespace

void register_index(CLI::App& app, Program& program) {
  struct Options {
    FileOptions files;
    index::VectorIndexOptions index;
    bool rebuild = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_command(app, "index", "embed the clips of a database and build its search index",
                  "remomask index motions.sqlite");
  command->add_option("db", options->files.database, "motion database")->required();
  options->files.add_model(*command);
  command->add_option("-o,--index", options->files.index,
                      "index file; default: beside the database");
  command->add_option("--factory", options->index.factory,
                      "FAISS index type, or auto: by the number of clips; default: the type of "
                      "the index that is there, else auto");
  command->add_option("--search-parameters", options->index.search_parameters,
                      "for approximate types, for example nprobe=16");
  command->add_flag("--rebuild", options->rebuild, "build anew instead of adding what is new");
  command->callback([command, options, &program] {
    const std::string model_path = options->files.model_path();
    const auto stages = nn::load_model(model_path);
    const retriever::Retriever retriever(require_stage(stages, "retriever", model_path));
    db::Database database(options->files.database_path(), db::OpenMode::read_write);
    const Monitor monitor = program.monitor();
    const int64_t embedded = retriever::embed_database(database, retriever, monitor);
    index::UpdateOptions update;
    update.rebuild = options->rebuild;
    if (command->count("--factory") + command->count("--search-parameters") > 0) {
      update.type = options->index;
    }
    const index::IndexUpdate made = index::update_index(options->files.index_path(), database,
                                                        retriever.hash(), update, monitor);
    program.finish_progress();
    if (program.json) return program.print_json(update_json(options->files, embedded, made));
    fmt::print("{}: {} clips, {} numbers each, {}\n", options->files.index_path(), made.count,
               made.width, describe_type(made.type));
    fmt::print("{} clips embedded, {} added, {} dropped{}\n", embedded, made.difference.added,
               made.difference.dropped,
               made.rebuilt.empty() ? "" : "; built anew: " + made.rebuilt);
  });
}

}  // namespace remomask::tools
