#include <fmt/format.h>

#include "retriever/embed_database.h"
#include "tools/program.h"
#include "tools/workspace.h"

namespace remomask {

void register_index(CLI::App& app, Program& program) {
  struct Options {
    FileOptions files;
    VectorIndexOptions index;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_command(app, "index", "embed the clips of a database and build its search index",
                  "remomask index motions.sqlite");
  command->add_option("db", options->files.database, "motion database")->required();
  options->files.add_model(*command);
  command->add_option("-o,--index", options->files.index,
                      "index file; default: beside the database");
  command->add_option("--factory", options->index.factory, "FAISS index type")
      ->capture_default_str();
  command->add_option("--search-parameters", options->index.search_parameters,
                      "for approximate types, for example nprobe=16");
  command->callback([options, &program] {
    const std::string model_path = options->files.model_path();
    const auto stages = load_model(model_path);
    const Retriever retriever(require_stage(stages, "retriever", model_path));
    Database database(options->files.database_path(), OpenMode::read_write);
    const Monitor monitor = program.monitor();
    embed_database(database, retriever, monitor);
    const VectorIndex index =
        VectorIndex::build(database, retriever.hash(), options->index, monitor);
    index.save(options->files.index_path());
    program.finish_progress();
    if (program.json) {
      return program.print_json({{"index", options->files.index_path()},
                                 {"clips", index.count()},
                                 {"width", index.width()},
                                 {"factory", index.factory()}});
    }
    fmt::print("{}: {} clips, {} numbers each, {}\n", options->files.index_path(), index.count(),
               index.width(), index.factory());
  });
}

}  // namespace remomask
