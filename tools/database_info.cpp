#include "tools/database_info.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "db/attribution.h"
#include "db/clip_filter.h"

namespace remomask::tools {

namespace {

/// More digits than these say nothing about a clip of 20 frames a second.
double rounded(double value, double digits) { return std::round(value * digits) / digits; }

/// Further lines of a text, such as a licence, stand below its first one.
std::string readable(const nlohmann::json& value) {
  if (value.is_number_float()) return fmt::format("{:g}", value.get<double>());
  if (!value.is_string()) return value.dump();
  std::string text;
  for (const char c : value.get_ref<const std::string&>()) {
    text += c;
    if (c == '\n') text.append(15, ' ');
  }
  return text;
}

}  // namespace

nlohmann::json describe_database(const std::string& path) {
  const db::Database database(path, db::OpenMode::read_only);
  const db::ReadSnapshot snapshot(database);
  std::map<std::string, int> splits, sources, licences, tags;
  size_t captions = 0;
  double seconds = 0;
  const auto clips = database.clips();
  for (const db::Clip& clip : clips) {
    ++splits[clip.split];
    ++sources[clip.source];
    ++licences[clip.licence];
    for (const std::string& tag : clip.tags) ++tags[tag];
    captions += clip.captions.size();
    seconds += clip_seconds(clip);
  }
  std::map<std::string, std::string> attributions;
  for (const auto& [source, count] : sources) {
    if (const auto text = db::attribution(database, source)) attributions[source] = *text;
  }
  std::map<std::string, size_t> embedded;
  for (const std::string& retriever : database.retrievers()) {
    embedded[retriever] = database.embedded_clips(retriever).size();
  }
  return {{"file", path},
          {"uuid", database.uuid()},
          {"generation", database.generation()},
          {"bytes", std::filesystem::file_size(path)},
          {"clips", clips.size()},
          {"captions", captions},
          {"minutes", rounded(seconds / 60, 10)},
          {"splits", splits},
          {"sources", sources},
          {"licences", licences},
          {"attributions", attributions},
          {"tags", tags},
          {"embedded", embedded}};
}

nlohmann::json clip_json(const db::Clip& clip) {
  return {{"id", clip.id},
          {"name", clip.name},
          {"source", clip.source},
          {"source_file", clip.source_file},
          {"start_frame", clip.start_frame},
          {"frames", clip.frames},
          {"seconds", rounded(clip_seconds(clip), 100)},
          {"speed", rounded(clip.speed, 1000)},
          {"split", clip.split},
          {"licence", clip.licence},
          {"group", clip.group},
          {"mirrored", clip.mirrored},
          {"skeleton", clip.skeleton},
          {"content_hash", clip.content_hash},
          {"captions", clip.captions},
          {"labels", clip.labels},
          {"tags", clip.tags}};
}

void print_description(const nlohmann::json& document) {
  for (const auto& [key, value] : document.items()) {
    if (value.is_object() && !value.empty()) {
      fmt::print("{}:\n", key);
      for (const auto& [name, entry] : value.items()) {
        fmt::print("  {:<12} {}\n", name.empty() ? "(unknown)" : name, readable(entry));
      }
    } else {
      fmt::print("{:<12} {}\n", key, readable(value));
    }
  }
}

}  // namespace remomask::tools
