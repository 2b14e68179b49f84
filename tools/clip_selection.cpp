#include "tools/clip_selection.h"

#include <algorithm>
#include <charconv>
#include <iterator>

#include "base/json.h"
#include "remomask/error.h"

namespace remomask::tools {

void ClipSelection::add(CLI::App& command) {
  command.add_option("clips", clips, "names of clips, or their numbers as #12");
  filter.add(command);
}

bool ClipSelection::empty() const { return clips.empty() && filter.filter().empty(); }

std::vector<int64_t> ClipSelection::ids(const db::Database& database) const {
  std::vector<int64_t> passing = db::matching_clips(database, filter.filter());
  if (clips.empty()) return passing;
  std::vector<int64_t> named, both;
  for (const std::string& clip : clips) named.push_back(find_clip(database, clip));
  std::sort(named.begin(), named.end());
  named.erase(std::unique(named.begin(), named.end()), named.end());
  std::set_intersection(named.begin(), named.end(), passing.begin(), passing.end(),
                        std::back_inserter(both));
  return both;
}

std::vector<int64_t> ClipSelection::chosen_ids(const db::Database& database) const {
  if (empty()) {
    throw Error("no clip is chosen; name clips, or choose them with filters such as --tag");
  }
  return ids(database);
}

int64_t find_clip(const db::Database& database, const std::string& name_or_id) {
  if (const auto id = database.find_name(name_or_id)) return *id;
  int64_t id = 0;
  const char* begin = name_or_id.data() + (name_or_id.starts_with("#") ? 1 : 0);
  const char* end = name_or_id.data() + name_or_id.size();
  const auto parsed = std::from_chars(begin, end, id);
  const bool is_number = parsed.ec == std::errc() && parsed.ptr == end;
  if (is_number && begin != name_or_id.data()) return database.clip(id).id;
  // Digits are a name first: data sets name their clips 000002.
  throw Error(database.path() + ": there is no clip named \"" + name_or_id + "\"; " +
              (is_number ? "write #" + std::to_string(id) + " for clip number " + std::to_string(id)
                         : "remomask db list shows the names"));
}

nlohmann::json parse_labels(const std::vector<std::string>& pairs) {
  nlohmann::json labels = nlohmann::json::object();
  for (const std::string& pair : pairs) {
    const LabelCondition label = db::parse_label_condition(pair);
    const auto value = try_parse_json(label.value);
    labels[label.key] = value.is_discarded() ? nlohmann::json(label.value) : value;
  }
  return labels;
}

}  // namespace remomask::tools
