#include "tools/workspace.h"

#include "db/captions_index.h"
#include "db/clip_filter.h"
#include "remomask/error.h"
#include "remomask/library.h"

namespace remomask::tools {

void FileOptions::add_model(CLI::App& command) {
  command.add_option("--model", model, "model file (.safetensors); default: the shipped model");
  command.add_option("--text", text,
                     "text file (.safetensors) with the sentence encoder; default: "
                     "text.safetensors beside the model, else the shipped one");
}

void FileOptions::add_database(CLI::App& command) {
  command.add_option("--db", database, "motion database; default: the shipped one");
  command.add_option("--index", index, "index file; default: beside the database");
}

std::string FileOptions::model_path() const {
  return model.empty() ? shipped_file("base.safetensors") : model;
}

std::string FileOptions::database_path() const {
  return database.empty() ? shipped_file("motions.sqlite") : database;
}

void FilterOptions::add(CLI::App& command) {
  add_repeatable(command, "--split", splits, "only clips of this split");
  add_repeatable(command, "--label", labels, "only clips with KEY=VALUE among their labels");
  command.add_option("--min-seconds", min_seconds, "only clips at least this long");
  command.add_option("--max-seconds", max_seconds, "only clips at most this long");
  add_repeatable(command, "--tag", tags, "only clips with this tag, or with all of several");
  add_repeatable(command, "--licence", licences, "only clips of this licence");
  command.add_option("--min-speed", min_speed,
                     "only clips at least this fast over the ground, m/s");
  command.add_option("--max-speed", max_speed, "only clips at most this fast over the ground, m/s");
  auto* plain =
      command.add_option("--words", words, "only clips with all these words in one caption");
  command
      .add_option("--caption-query", caption_query,
                  "only clips whose captions answer this FTS5 query, for example 'walk NOT run*'; "
                  "not with --words")
      ->excludes(plain);
}

ClipFilter FilterOptions::filter() const {
  ClipFilter result;
  result.splits = splits;
  for (const std::string& label : labels) result.labels.push_back(db::parse_label_condition(label));
  result.min_seconds = min_seconds;
  result.max_seconds = max_seconds;
  result.tags = tags;
  result.licences = licences;
  result.min_speed = min_speed;
  result.max_speed = max_speed;
  result.caption_query = words.empty() ? caption_query : db::quote_caption_words(words);
  if (!words.empty() && result.caption_query.empty()) {
    throw Error("--words '" + words + "' holds no word; write letters or digits");
  }
  return result;
}

}  // namespace remomask::tools
