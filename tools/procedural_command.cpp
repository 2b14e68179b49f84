#include <fmt/format.h>

#include "base/counted.h"
#include "db/clip_hash.h"
#include "db/database.h"
#include "db/storing_database.h"
#include "db/transaction.h"
#include "remomask/error.h"
#include "synthetic/procedural.h"
#include "tools/program.h"
#include "tools/usage.h"

namespace remomask::tools {

void register_procedural(CLI::App& app, Program& program) {
  struct Options {
    std::string database;
    synthetic::ProceduralOptions make;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_command(app, "procedural",
                  "add motions computed by formulas, with captions, to a database (needs no data)",
                  "remomask procedural --db motions.sqlite --count 360");
  command->add_option("--db", options->database, "database file; created when missing")->required();
  command->add_option("--count", options->make.count, "number of clips")
      ->capture_default_str()
      ->check(at_least(1));
  command->add_option("--seed", options->make.seed, "another seed makes other clips")
      ->capture_default_str();
  command->callback([options, &program] {
    db::StoringDatabase storing(options->database);
    db::Database& database = *storing;
    const Monitor monitor = program.monitor();
    const auto clips = synthetic::make_procedural_clips(options->make, monitor);
    int added = 0, known = 0;
    db::Transaction transaction(database);
    for (const synthetic::ProceduralClip& made : clips) {
      if (monitor.stop_requested()) throw Interrupted("stopped; nothing was stored");
      db::Clip clip;
      // Every seed makes clips of the same kinds and numbers: names must differ.
      clip.name = options->make.seed == synthetic::ProceduralOptions().seed
                      ? made.name
                      : fmt::format("{}@{}", made.name, options->make.seed);
      clip.source = "procedural";
      clip.source_file = clip.name;
      clip.split = made.split;
      clip.licence = "MIT";
      clip.group = "procedural/" + clip.name;
      clip.content_hash = db::clip_content_hash(made.motion);
      clip.frames = made.motion.frames;
      clip.captions = made.captions;
      clip.labels = made.labels;
      if (database.find_content(clip.content_hash)) {
        ++known;
      } else {
        database.add_clip(clip, made.motion);
        ++added;
      }
      monitor.report({"store motions", static_cast<double>(added + known),
                      static_cast<double>(clips.size()), ""});
    }
    transaction.commit();
    program.finish_progress();
    if (program.json) return program.print_json({{"added", added}, {"known", known}});
    fmt::print("{}: {} added, {} already there\n", options->database, counted(added, "motion"),
               known);
  });
}

}  // namespace remomask::tools
