#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>

#include "base/counted.h"
#include "db/transaction.h"
#include "remomask/error.h"
#include "tools/clip_selection.h"
#include "tools/core.h"
#include "tools/db_commands.h"
#include "tools/describe_command.h"
#include "tools/usage.h"

namespace remomask::tools {

namespace {

struct DescribeOptions {
  DescribeCommand guess;
  ClipSelection selection;
  bool accept = false, remove = false;
};

void remove_guesses(const DescribeOptions& options, Program& program) {
  db::Database database(options.guess.files.database, db::OpenMode::read_write);
  const int64_t removed = database.remove_guesses(options.selection.ids(database));
  if (program.json) return program.print_json({{"removed", removed}});
  fmt::print("guessed captions of {} removed\n", counted(removed, "clip"));
}

/// The most probable guess of each clip becomes its caption, as if somebody had written it.
void accept_guesses(const DescribeOptions& options, Program& program) {
  db::Database database(options.guess.files.database, db::OpenMode::read_write);
  db::Transaction transaction(database);
  std::map<int64_t, std::string> best;
  for (const db::GuessedCaption& guess : database.guessed_captions()) {
    best.emplace(guess.clip_id, guess.text);
  }
  nlohmann::json accepted = nlohmann::json::array();
  for (const int64_t id : options.selection.chosen_ids(database)) {
    const auto caption = best.find(id);
    if (caption == best.end()) continue;
    db::ClipChanges changes;
    changes.captions = {caption->second};
    database.update_clip(id, changes);
    accepted.push_back({{"clip", database.clip(id).name}, {"caption", caption->second}});
  }
  transaction.commit();
  if (program.json) return program.print_json({{"accepted", accepted}});
  for (const auto& one : accepted) {
    fmt::print("{}: {}\n", one.at("clip").get<std::string>(), one.at("caption").get<std::string>());
  }
  fmt::print("{} described; run: remomask index {}\n",
             counted(static_cast<int64_t>(accepted.size()), "clip"), database.path());
}

void guess_captions(DescribeOptions& options, Program& program) {
  {
    const db::Database database(options.guess.files.database, db::OpenMode::read_only);
    for (const int64_t id : options.selection.ids(database)) {
      if (database.clip(id).captions.empty()) options.guess.clips.push_back(id);
    }
  }
  core(program).describe(options.guess, program);
}

}  // namespace

void register_db_describe(CLI::App& group, Program& program) {
  auto options = std::make_shared<DescribeOptions>();
  CLI::App* command = add_command(group, "describe",
                                  "guess captions for clips without any from clips that move alike",
                                  "remomask db describe motions.sqlite\n  remomask db describe "
                                  "motions.sqlite walk_01 --accept");
  command->add_option("database", options->guess.files.database, "database file, indexed")
      ->required();
  options->guess.files.add_model(*command);
  options->selection.add(*command);
  command
      ->add_option("--min-probability", options->guess.min_probability,
                   "leave out what is less probably right")
      ->capture_default_str()
      ->check(number_between(0.0, 1.0));
  command->add_option("--captions", options->guess.captions, "of one clip, at most")
      ->capture_default_str()
      ->check(number_between(1, 10));
  CLI::Option* accept = command->add_flag(
      "--accept", options->accept, "the best guess of these clips is right: make it their caption");
  command->add_flag("--remove", options->remove, "forget what was guessed")->excludes(accept);
  command->callback([options, &program] {
    if (options->accept) return accept_guesses(*options, program);
    if (options->remove) return remove_guesses(*options, program);
    guess_captions(*options, program);
  });
}

}  // namespace remomask::tools
