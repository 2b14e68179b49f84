#include <fmt/format.h>

#include "tools/program.h"
#include "tools/workspace.h"

namespace remomask {

void register_search(CLI::App& app, Program& program) {
  struct Options {
    std::string text;
    FileOptions files;
    FilterOptions filter;
    int k = 10;
    bool ungrouped = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = add_command(app, "search", "find motions by meaning",
                                  "remomask search \"someone waves\" -k 5 --min-seconds 2");
  command->add_option("text", options->text, "what to look for")->required();
  options->files.add_database(*command);
  options->files.add_model(*command);
  options->filter.add(*command);
  command->add_option("-k", options->k, "number of hits")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_flag("--ungrouped", options->ungrouped,
                    "list windows, mirror copies and duplicates of a motion one by one");
  command->callback([options, &program] {
    const std::string model_path = options->files.model_path();
    const SearchWorkspace workspace(load_model(model_path), model_path,
                                    options->files.database_path(), options->files.index_path());
    SearchOptions search;
    search.k = options->k;
    search.filter = options->filter.filter();
    search.collapse = options->ungrouped ? Collapse::none : Collapse::groups;
    const auto hits = workspace.search(options->text, search);
    if (program.json) {
      return program.print_json({{"query", options->text}, {"hits", hits_json(hits)}});
    }
    if (hits.empty()) fmt::print("no clip passes the filters\n");
    for (const SearchHit& hit : hits) {
      fmt::print("{:3}  {:.3f}  {:5.1f} s  {:<32} {}\n", hit.rank, hit.similarity,
                 clip_seconds(hit.clip), hit.clip.name,
                 hit.clip.captions.empty() ? "" : hit.clip.captions.front());
    }
  });
}

}  // namespace remomask
