#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/counted.h"
#include "db/attribution.h"
#include "db/storing_database.h"
#include "db/transaction.h"
#include "exchange/add_files.h"
#include "remomask/error.h"
#include "tools/clip_selection.h"
#include "tools/db_commands.h"
#include "tools/reading_options.h"

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
  command->add_option("database", options->database, "database file; created when missing")
      ->required();
  command->add_option("files", options->files, "motion files (BVH, AMC, npy, npz)")->required();
  // The second names are those of `db tag`, where the first ones are filters.
  add_repeatable(*command, "--caption,--add-caption", options->add.captions,
                 "caption of all these files");
  add_repeatable(*command, "--label,--set-label", options->labels,
                 "KEY=VALUE, a label of all these files");
  add_repeatable(*command, "--tag,--add-tag", options->add.tags, "tag of all these files");
  command->add_option("--split,--set-split", options->add.split, "train, val, test or none")
      ->capture_default_str();
  command->add_option("--licence,--set-licence", options->add.licence, "licence of these motions");
  command->add_option("--source", options->add.source, "name of the data set")
      ->capture_default_str();
  add_reading_options(*command, options->add);
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
    program.print_json({{"clips", clips}, {"rejected", rejected}, {"warnings", report.warnings}});
    if (!program.json) {
      for (const std::string& warning : report.warnings) program.warn(warning);
      for (const auto& [id, name] : report.clips) fmt::print("added {} as number {}\n", name, id);
      for (const auto& entry : report.rejected) {
        program.warn(entry.file + " was left out: " + entry.reason);
      }
    }
    if (!report.rejected.empty()) {
      throw Error(fmt::format("{} of {} left out", report.rejected.size(),
                              counted(static_cast<int64_t>(options->files.size()), "file")));
    }
  });
}

struct TagOptions {
  std::string database;
  ClipSelection selection;
  std::vector<std::string> added, dropped, labels, captions, added_captions;
  std::optional<std::string> split, licence;

  bool empty() const {
    return added.empty() && dropped.empty() && labels.empty() && captions.empty() && !split &&
           added_captions.empty() && !licence;
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
    if (!captions.empty() || !added_captions.empty()) {
      changes.captions = captions.empty() ? clip.captions : captions;
      for (const std::string& caption : added_captions) {
        auto& all = *changes.captions;
        if (std::find(all.begin(), all.end(), caption) == all.end()) all.push_back(caption);
      }
    }
    changes.split = split;
    changes.licence = licence;
    return changes;
  }
};

void register_tag(CLI::App& group, Program& program) {
  auto options = std::make_shared<TagOptions>();
  CLI::App* command =
      add_command(group, "tag", "change tags, labels, split, licence or captions of clips",
                  "remomask db tag motions.sqlite --words jump --min-seconds 2 --add-tag air");
  command->add_option("database", options->database, "database file")->required();
  options->selection.add(*command);
  add_repeatable(*command, "--add-tag,--add", options->added, "give these clips this tag");
  add_repeatable(*command, "--drop-tag,--drop", options->dropped, "take this tag from these clips");
  add_repeatable(*command, "--set-label", options->labels,
                 "KEY=VALUE: give these clips this label; KEY=null removes it");
  command->add_option("--set-split", options->split, "train, val, test or none");
  command->add_option("--set-licence", options->licence, "licence of these clips");
  add_repeatable(*command, "--add-caption", options->added_captions,
                 "caption to add to those of these clips");
  add_repeatable(*command, "--set-caption", options->captions,
                 "caption that replaces all those of these clips");
  command->callback([options, &program] {
    if (options->empty()) {
      throw Error("no change is given; give --add-tag, --drop-tag, --add-caption or --set-...");
    }
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

/// "walk, jump, bow and 9 more".
std::string some_of(const std::vector<std::string>& names) {
  constexpr size_t kShown = 3;
  std::string text;
  for (size_t i = 0; i < std::min(kShown, names.size()); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  return names.size() <= kShown ? text : fmt::format("{} and {} more", text, names.size() - kShown);
}

void register_remove(CLI::App& group, Program& program) {
  struct Options {
    std::string database;
    ClipSelection selection;
    bool yes = false, dry_run = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_command(group, "remove", "remove clips with their captions, tags and vectors",
                  "remomask db remove motions.sqlite --tag broken --yes");
  command->add_option("database", options->database, "database file")->required();
  options->selection.add(*command);
  command->add_flag("--yes", options->yes,
                    "confirms the removal of several clips that filters chose");
  command->add_flag("--dry-run", options->dry_run, "show which clips would go, remove none");
  command->callback([options, &program] {
    db::Database database(options->database, db::OpenMode::read_write);
    db::Transaction transaction(database);
    const auto ids = options->selection.chosen_ids(database);
    std::vector<std::string> names;
    for (const int64_t id : ids) names.push_back(database.clip(id).name);
    const std::string count = counted(static_cast<int64_t>(names.size()), "clip");
    const bool must_confirm = options->selection.clips.empty() && names.size() > 1;
    if (must_confirm && !options->yes && !options->dry_run) {
      throw Error(
          fmt::format("this would remove {} ({}); --dry-run lists them, --yes removes "
                      "them (remomask db snapshot keeps a copy)",
                      count, some_of(names)));
    }
    if (!options->dry_run) {
      database.remove(ids);
      transaction.commit();
    }
    const int64_t left =
        database.clip_count() - (options->dry_run ? static_cast<int64_t>(names.size()) : 0);
    if (program.json) {
      return program.print_json(
          {{options->dry_run ? "would_remove" : "removed", names}, {"clips_left", left}});
    }
    if (names.empty()) return fmt::print("no clip passes the filters\n");
    for (const std::string& name : names) {
      fmt::print("{} {}\n", options->dry_run ? "would remove" : "removed", name);
    }
    fmt::print("{}: {} {}, {} left\n", options->database, count,
               options->dry_run ? "would be removed" : "removed", counted(left, "clip"));
  });
}

void register_attribute(CLI::App& group, Program& program) {
  struct Options {
    std::string database, source, text;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = add_command(
      group, "attribute", "store whom the licence of a data set asks to be named; db info shows it",
      "remomask db attribute motions.sqlite lafan \"LaFAN1, (c) Ubisoft, CC BY-NC-ND 4.0\"");
  command->add_option("database", options->database, "database file")->required();
  command->add_option("source", options->source, "name of the data set")->required();
  command->add_option("text", options->text, "replaces what is there; \"\" removes it")->required();
  command->callback([options, &program] {
    db::Database database(options->database, db::OpenMode::read_write);
    db::set_attribution(database, options->source, options->text);
    if (program.json) {
      return program.print_json({{"source", options->source}, {"attribution", options->text}});
    }
    fmt::print("{}: attribution of {} {}\n", options->database, options->source,
               options->text.empty() ? "removed" : "stored");
  });
}

}  // namespace

void register_db_change(CLI::App& group, Program& program) {
  register_add(group, program);
  register_tag(group, program);
  register_remove(group, program);
  register_attribute(group, program);
}

}  // namespace remomask::tools
