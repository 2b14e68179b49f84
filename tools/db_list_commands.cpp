#include <fmt/format.h>

#include "base/counted.h"
#include "tools/clip_selection.h"
#include "tools/database_info.h"
#include "tools/db_commands.h"
#include "tools/usage.h"

namespace remomask::tools {

namespace {

void print_clip_line(const db::Clip& clip) {
  std::string tags;
  for (const std::string& tag : clip.tags) tags += " [" + tag + "]";
  fmt::print("{:6}  {:5.1f} s  {:4.1f} m/s  {:<5}  {:<32}{} {}\n", clip.id, clip_seconds(clip),
             clip.speed, clip.split, clip.name, tags,
             clip.captions.empty() ? "" : clip.captions.front());
}

void register_list(CLI::App& group, Program& program) {
  struct Options {
    std::string database;
    FilterOptions filter;
    int limit = 0;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_command(group, "list", "list the clips that pass the filters",
                  "remomask db list motions.sqlite --label content=walk --min-speed 0.5");
  command->add_option("database", options->database, "database file")->required();
  options->filter.add(*command);
  command->add_option("--limit", options->limit, "maximum number of clips to show; 0: all")
      ->capture_default_str()
      ->check(at_least(0));
  command->callback([options, &program] {
    const db::Database database(options->database, db::OpenMode::read_only);
    const db::ReadSnapshot snapshot(database);
    const auto ids = db::matching_clips(database, options->filter.filter());
    size_t shown = ids.size();
    if (options->limit > 0) shown = std::min(shown, static_cast<size_t>(options->limit));
    nlohmann::json clips = nlohmann::json::array();
    for (size_t i = 0; i < shown; ++i) {
      const db::Clip clip = database.clip(ids[i]);
      if (program.json) {
        clips.push_back(clip_json(clip));
      } else {
        print_clip_line(clip);
      }
    }
    if (program.json) return program.print_json({{"clips", clips}, {"matching", ids.size()}});
    fmt::print("{} of {} pass the filters, {} shown\n", ids.size(),
               counted(database.clip_count(), "clip"), shown);
  });
}

void register_show(CLI::App& group, Program& program) {
  struct Options {
    std::string database;
    std::vector<std::string> clips;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = add_command(group, "show", "show everything stored about clips",
                                  "remomask db show motions.sqlite walk_01");
  command->add_option("database", options->database, "database file")->required();
  command->add_option("clips", options->clips, "names of clips, or their numbers as #12")
      ->required();
  command->callback([options, &program] {
    const db::Database database(options->database, db::OpenMode::read_only);
    const db::ReadSnapshot snapshot(database);
    nlohmann::json clips = nlohmann::json::array();
    for (const std::string& name : options->clips) {
      const int64_t id = find_clip(database, name);
      nlohmann::json clip = clip_json(database.clip(id));
      nlohmann::json retrievers = nlohmann::json::array();
      for (const std::string& retriever : database.retrievers()) {
        if (database.embedding(retriever, id)) retrievers.push_back(retriever);
      }
      clip["embedded"] = retrievers;
      for (const db::GuessedCaption& guess : database.guessed_captions()) {
        if (guess.clip_id != id) continue;
        clip["guessed_captions"].push_back(
            {{"text", guess.text}, {"probability", guess.probability}});
      }
      clips.push_back(clip);
    }
    if (program.json) return program.print_json({{"clips", clips}});
    for (const auto& clip : clips) {
      print_description(clip);
      fmt::print("\n");
    }
  });
}

}  // namespace

void register_db_list(CLI::App& group, Program& program) {
  register_list(group, program);
  register_show(group, program);
}

}  // namespace remomask::tools
