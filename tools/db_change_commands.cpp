#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/counted.h"
#include "db/storing_database.h"
#include "db/transaction.h"
#include "exchange/add_files.h"
#include "remomask/error.h"
#include "tools/clip_selection.h"
#include "tools/db_commands.h"

namespace remomask::tools {

namespace {

void register_add(CLI::App& group, Program& program) {
  struct Options {
    std::string database;
    std::vector<std::string> files, labels;
    exchange::AddOptions add;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = add_command(
      group, "add", "store single motion files as clips",
      "remomask db add motions.sqlite bow.bvh --caption \"a person bows\" --tag new --split train");
  command->add_option("database", options->database, "database file; made when missing")
      ->required();
  command->add_option("files", options->files, "BVH or npy files")->required();
  add_repeatable(*command, "--caption", options->add.captions, "of all these files");
  add_repeatable(*command, "--label", options->labels, "KEY=VALUE, of all these files");
  add_repeatable(*command, "--tag", options->add.tags, "of all these files");
  command->add_option("--split", options->add.split, "train, val, test or none")
      ->capture_default_str();
  command->add_option("--licence", options->add.licence, "licence of these motions");
  command->add_option("--source", options->add.source, "name of the data set")
      ->capture_default_str();
  command->add_option("--skeleton-map", options->add.skeleton_map,
                      "name of a shipped map or a map file; default: found by joint names");
  command->callback([options, &program] {
    options->add.labels = parse_labels(options->labels);
    db::StoringDatabase storing(options->database);
    db::Database& database = *storing;
    const exchange::AddReport report = exchange::add_files(database, options->files, options->add);
    nlohmann::json clips = nlohmann::json::array(), rejected = nlohmann::json::array();
    for (const auto& [id, name] : report.clips) clips.push_back({{"id", id}, {"name", name}});
    for (const auto& entry : report.rejected) {
      rejected.push_back({{"file", entry.file}, {"reason", entry.reason}});
    }
    program.print_json({{"clips", clips}, {"rejected", rejected}});
    if (!program.json) {
      for (const auto& [id, name] : report.clips) fmt::print("added {} as number {}\n", name, id);
      for (const auto& entry : report.rejected) {
        program.warn(entry.file + " was left out: " + entry.reason);
      }
    }
    if (!report.rejected.empty()) {
      throw Error(fmt::format("{} of {} files were left out", report.rejected.size(),
                              options->files.size()));
    }
  });
}

struct TagOptions {
  std::string database;
  ClipSelection selection;
  std::vector<std::string> added, dropped, labels, captions;
  std::optional<std::string> split, licence;

  bool empty() const {
    return added.empty() && dropped.empty() && labels.empty() && captions.empty() && !split &&
           !licence;
  }
  db::ClipChanges changes(const db::Clip& clip) const {
    db::ClipChanges changes;
    std::vector<std::string> tags = clip.tags;
    tags.insert(tags.end(), added.begin(), added.end());
    std::erase_if(tags, [this](const std::string& tag) {
      return std::find(dropped.begin(), dropped.end(), tag) != dropped.end();
    });
    changes.tags = tags;
    if (!labels.empty()) changes.labels = parse_labels(labels);
    if (!captions.empty()) changes.captions = captions;
    changes.split = split;
    changes.licence = licence;
    return changes;
  }
};

void register_tag(CLI::App& group, Program& program) {
  auto options = std::make_shared<TagOptions>();
  CLI::App* command =
      add_command(group, "tag", "change tags, labels, split, licence or captions of clips",
                  "remomask db tag motions.sqlite --words jump --min-seconds 2 --add air");
  command->add_option("database", options->database, "database file")->required();
  options->selection.add(*command);
  add_repeatable(*command, "--add", options->added, "tag to give to these clips");
  add_repeatable(*command, "--drop", options->dropped, "tag to take from these clips");
  add_repeatable(*command, "--set-label", options->labels,
                 "KEY=VALUE to give to these clips; KEY=null takes it away");
  command->add_option("--set-split", options->split, "train, val, test or none");
  command->add_option("--set-licence", options->licence, "licence of these clips");
  add_repeatable(*command, "--set-caption", options->captions,
                 "new caption in the place of all old ones");
  command->callback([options, &program] {
    if (options->empty()) throw Error("nothing is to be changed; say --add, --drop or --set-...");
    db::Database database(options->database, db::OpenMode::read_write);
    db::Transaction transaction(database);
    const auto ids = options->selection.chosen_ids(database);
    int64_t changed = 0;
    for (const int64_t id : ids) {
      changed += database.update_clip(id, options->changes(database.clip(id))) ? 1 : 0;
    }
    transaction.commit();
    if (program.json) {
      return program.print_json({{"chosen", ids.size()}, {"changed", changed}});
    }
    fmt::print("{} chosen, {} changed\n", counted(static_cast<int64_t>(ids.size()), "clip"),
               changed);
  });
}

void register_remove(CLI::App& group, Program& program) {
  struct Options {
    std::string database;
    ClipSelection selection;
    bool yes = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = add_command(group, "remove", "remove clips with all that belongs to them",
                                  "remomask db remove motions.sqlite --tag broken --yes");
  command->add_option("database", options->database, "database file")->required();
  options->selection.add(*command);
  command->add_flag("--yes", options->yes, "needed when more than one clip is meant");
  command->callback([options, &program] {
    db::Database database(options->database, db::OpenMode::read_write);
    db::Transaction transaction(database);
    const auto ids = options->selection.chosen_ids(database);
    if (ids.size() > 1 && !options->yes) {
      throw Error(
          fmt::format("this would remove {} clips, for example '{}'; add --yes if that is "
                      "meant (remomask db snapshot keeps a copy)",
                      ids.size(), database.clip(ids.front()).name));
    }
    std::vector<std::string> names;
    for (const int64_t id : ids) names.push_back(database.clip(id).name);
    database.remove(ids);
    transaction.commit();
    if (program.json) return program.print_json({{"removed", names}});
    for (const std::string& name : names) fmt::print("removed {}\n", name);
    fmt::print("{}\n", names.empty() ? "no clip passes the filters"
                                     : counted(static_cast<int64_t>(names.size()), "clip") +
                                           " removed from " + options->database);
  });
}

}  // namespace

void register_db_change(CLI::App& group, Program& program) {
  register_add(group, program);
  register_tag(group, program);
  register_remove(group, program);
}

}  // namespace remomask::tools
