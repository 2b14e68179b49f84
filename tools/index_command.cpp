#include "tools/index_command.h"

#include <CLI/CLI.hpp>

#include "tools/core.h"

namespace remomask::tools {

void register_index(CLI::App& app, Program& program) {
  auto options = std::make_shared<IndexCommand>();
  CLI::App* command =
      add_command(app, "index", "embed the clips of a database and build its search index",
                  "remomask index motions.sqlite");
  command->add_option("db", options->files.database, "motion database")->required();
  options->files.add_model(*command);
  command->add_option("-o,--index", options->files.index,
                      "index file; default: beside the database");
  command->add_option("--factory", options->factory,
                      "FAISS index type, or auto: by the number of clips; default: the type of "
                      "the index that is there, else auto");
  command->add_option("--search-parameters", options->search_parameters,
                      "for approximate types, for example nprobe=16");
  command->add_flag("--rebuild", options->rebuild, "build anew instead of adding what is new");
  command->callback([options, &program] { core(program).index(*options, program); });
}

}  // namespace remomask::tools
