#include "exchange/captions_file.h"

#include <optional>
#include <string_view>

#include "base/json.h"
#include "remomask/error.h"
#include "text/encoding.h"

namespace remomask::exchange {

namespace {

class CaptionLine {
 public:
  CaptionLine(const std::string& path, long line, std::string_view text)
      : path_(path), line_(line) {
    try {
      json_ = parse_json(text);
    } catch (const nlohmann::json::exception& error) {
      fail("is not JSON (" + json_reason(error) + "); correct or remove the line");
    }
    if (!json_.is_object()) fail(R"(is not of the form {"clip": "...", "captions": [...]})");
  }

  CaptionEntry entry() const {
    CaptionEntry entry;
    entry.line = line_;
    entry.clip = text("clip", true);
    if (entry.clip.empty()) fail("the clip has no name");
    entry.captions = captions();
    if (const auto labels = json_.find("labels"); labels != json_.end()) {
      if (!labels->is_object()) fail("\"labels\" must be a JSON object");
      entry.labels = *labels;
    }
    const std::string split = text("split", false);
    if (!split.empty()) entry.split = split;
    if (entry.split != "train" && entry.split != "val" && entry.split != "test" &&
        entry.split != "none") {
      fail("unknown split '" + split + "'; use train, val, test or none");
    }
    entry.name = text("name", false);
    entry.group = text("group", false);
    entry.licence = text("licence", false);
    entry.tags = texts("tags");
    if (const auto canonical = json_.find("canonical"); canonical != json_.end()) {
      if (!canonical->is_boolean()) fail("\"canonical\" must be true or false");
      entry.canonical = canonical->get<bool>();
    }
    return entry;
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw FileError(path_, line_, message);
  }

 private:
  std::string text(const char* key, bool required) const {
    const auto value = json_.find(key);
    if (value == json_.end()) {
      if (required) fail(std::string("\"") + key + "\" is missing");
      return "";
    }
    if (!value->is_string()) fail(std::string("\"") + key + "\" must be a text");
    return value->get<std::string>();
  }

  std::vector<std::string> captions() const {
    const auto value = json_.find("captions");
    if (value != json_.end()) {
      return value->is_string() ? std::vector{value->get<std::string>()} : texts("captions");
    }
    for (const char* other : {"caption", "text", "texts"}) {
      if (json_.contains(other)) {
        fail(std::string("\"") + other + "\" is not read; name the list of captions \"captions\"");
      }
    }
    return {};
  }

  std::vector<std::string> texts(const char* key) const {
    std::vector<std::string> list;
    const auto values = json_.find(key);
    if (values == json_.end()) return list;
    const std::string complaint = std::string("\"") + key + "\" must be a list of texts";
    if (!values->is_array()) fail(complaint);
    for (const auto& value : *values) {
      if (!value.is_string()) fail(complaint);
      list.push_back(value.get<std::string>());
    }
    return list;
  }

  const std::string& path_;
  long line_;
  nlohmann::json json_;
};

}  // namespace

CaptionsFile::CaptionsFile(const std::string& path) : path_(path) {
  const std::string content = text::read_lines_file(path);
  std::optional<FileError> first_failure;
  std::string_view rest = content;
  for (long line = 1; !rest.empty(); ++line) {
    const size_t end = rest.find('\n');
    const std::string_view text = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    if (text.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    try {
      add(CaptionLine(path, line, text).entry());
    } catch (const FileError& error) {
      if (!first_failure) first_failure.emplace(error);
      warnings_.push_back(std::string(error.what()) + ". The line is left out");
    }
  }
  if (entries_.empty() && first_failure) throw FileError(*first_failure);
}

void CaptionsFile::add(CaptionEntry entry) {
  const auto [place, is_new] = places_.emplace(entry.clip, entries_.size());
  if (!is_new) {
    throw FileError(path_, entry.line,
                    "clip '" + entry.clip + "' was given in line " +
                        std::to_string(entries_[place->second].line) +
                        " already; put all its captions into one line");
  }
  entries_.push_back(std::move(entry));
}

const CaptionEntry* CaptionsFile::find(const std::string& clip) const {
  const auto place = places_.find(clip);
  return place == places_.end() ? nullptr : &entries_[place->second];
}

}  // namespace remomask::exchange
