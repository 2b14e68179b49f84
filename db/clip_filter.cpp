#include "db/clip_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <set>

#include "remomask/error.h"

namespace remomask {

bool ClipFilter::empty() const {
  return splits.empty() && labels.empty() && tags.empty() && licences.empty() && !min_seconds &&
         !max_seconds && !min_speed && !max_speed && caption_query.empty() &&
         excluded_groups.empty() && excluded_clips.empty() && !exclude_mirrored;
}

double clip_seconds(const ClipInfo& clip) {
  return clip.frames / skeleton_named(clip.skeleton).fps;
}

}  // namespace remomask

namespace remomask::db {

namespace {

const nlohmann::json* find_label(const nlohmann::json& labels, const std::string& key) {
  if (!labels.is_object()) return nullptr;
  if (const auto whole = labels.find(key); whole != labels.end()) return &*whole;
  for (size_t dot = key.find('.'); dot != std::string::npos; dot = key.find('.', dot + 1)) {
    const auto outer = labels.find(key.substr(0, dot));
    if (outer == labels.end()) continue;
    if (const auto* found = find_label(*outer, key.substr(dot + 1))) return found;
  }
  return nullptr;
}

bool label_equals(const nlohmann::json& label, const std::string& value) {
  if (label.is_array()) {
    return std::any_of(label.begin(), label.end(), [&](const nlohmann::json& member) {
      return !member.is_array() && label_equals(member, value);
    });
  }
  if (label.is_string()) return label.get_ref<const std::string&>() == value;
  if (label.is_boolean()) return value == (label.get<bool>() ? "true" : "false");
  if (label.is_number()) {
    double number = 0;
    const char* end = value.data() + value.size();
    const auto parsed = std::from_chars(value.data(), end, number);
    return parsed.ec == std::errc() && parsed.ptr == end && number == label.get<double>();
  }
  return false;
}

bool contains(const std::vector<std::string>& list, const std::string& value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

/// `unit` follows each number, for example " s".
void check_range(const char* what, const char* unit, const std::optional<double>& least,
                 const std::optional<double>& most) {
  if (!least || !most || *least <= *most) return;
  throw Error(fmt::format("the smallest {} ({}{}) is above the largest ({}{}); exchange them", what,
                          *least, unit, *most, unit));
}

template <typename HasIt>
void check_known(const std::vector<Clip>& clips, const std::string& what, HasIt has_it) {
  if (std::any_of(clips.begin(), clips.end(), has_it)) return;
  throw Error("no clip has " + what + "; check how it is written");
}

void add_texts(const nlohmann::json& label, std::set<std::string>& texts) {
  if (label.is_string()) texts.insert(label.get<std::string>());
  if (!label.is_array()) return;
  for (const nlohmann::json& member : label) add_texts(member, texts);
}

/// A vocabulary has too many words to list: those that begin like the wrong one
/// show how it is written.
void check_label(const std::vector<Clip>& clips, const LabelCondition& condition) {
  constexpr size_t kAlike = 3;
  std::set<std::string> texts;
  for (const Clip& clip : clips) {
    const nlohmann::json* label = find_label(clip.labels, condition.key);
    if (label && label_equals(*label, condition.value)) return;
    if (label) add_texts(*label, texts);
  }
  const auto begins_alike = [&](const std::string& text) {
    return text.compare(0, kAlike, condition.value, 0, kAlike) == 0;
  };
  std::string alike;
  for (const std::string& text : texts) {
    if (begins_alike(text)) alike += (alike.empty() ? "" : ", ") + text;
  }
  throw Error(
      "no clip has the label " + condition.key + "=" + condition.value +
      (alike.empty() ? "; check how it is written" : "; values that begin alike: " + alike));
}

void check_filter(const std::vector<Clip>& clips, const ClipFilter& filter) {
  for (const std::string& split : filter.splits) {
    if (split != "train" && split != "val" && split != "test" && split != "none") {
      throw Error("unknown split '" + split + "'; use train, val, test or none");
    }
  }
  check_range("length", " s", filter.min_seconds, filter.max_seconds);
  check_range("speed", " m/s", filter.min_speed, filter.max_speed);
  for (const LabelCondition& condition : filter.labels) {
    check_known(clips, "a label '" + condition.key + "'", [&](const Clip& clip) {
      return find_label(clip.labels, condition.key) != nullptr;
    });
    check_label(clips, condition);
  }
  for (const std::string& tag : filter.tags) {
    check_known(clips, "the tag '" + tag + "'",
                [&](const Clip& clip) { return contains(clip.tags, tag); });
  }
  for (const std::string& licence : filter.licences) {
    check_known(clips, "the licence '" + licence + "'",
                [&](const Clip& clip) { return clip.licence == licence; });
  }
}

bool is_within(double value, const std::optional<double>& least,
               const std::optional<double>& most) {
  return (!least || value >= *least) && (!most || value <= *most);
}

bool clip_matches(const Clip& clip, const ClipFilter& filter) {
  if (!filter.splits.empty() && !contains(filter.splits, clip.split)) return false;
  if (!filter.licences.empty() && !contains(filter.licences, clip.licence)) return false;
  if (!is_within(clip_seconds(clip), filter.min_seconds, filter.max_seconds)) return false;
  if (!is_within(clip.speed, filter.min_speed, filter.max_speed)) return false;
  for (const std::string& tag : filter.tags) {
    if (!contains(clip.tags, tag)) return false;
  }
  if (filter.exclude_mirrored && clip.mirrored) return false;
  if (filter.excluded_clips.contains(clip.id)) return false;
  if (filter.excluded_groups.contains(clip.group)) return false;
  return std::all_of(filter.labels.begin(), filter.labels.end(),
                     [&](const auto& condition) { return has_label(clip.labels, condition); });
}

}  // namespace

bool has_label(const nlohmann::json& labels, const LabelCondition& condition) {
  const nlohmann::json* label = find_label(labels, condition.key);
  return label && label_equals(*label, condition.value);
}

LabelCondition parse_label_condition(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw Error("'" + text + "' is no label condition; write key=value, for example content=walk");
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

std::vector<int64_t> matching_clips(const Database& database, const ClipFilter& filter) {
  const ReadSnapshot snapshot(database);
  return matching_clips(database, database.clips(), filter);
}

std::vector<int64_t> matching_clips(const Database& database, const std::vector<Clip>& clips,
                                    const ClipFilter& filter) {
  ClipFilter others = filter;
  others.caption_query.clear();
  std::vector<int64_t> ids = matching_clips(clips, others);
  if (filter.caption_query.empty()) return ids;
  std::vector<int64_t> worded, both;
  for (const CaptionMatch& match : database.match_captions(filter.caption_query)) {
    worded.push_back(match.clip_id);
  }
  std::sort(worded.begin(), worded.end());
  std::set_intersection(ids.begin(), ids.end(), worded.begin(), worded.end(),
                        std::back_inserter(both));
  return both;
}

std::vector<int64_t> matching_clips(const std::vector<Clip>& clips, const ClipFilter& filter) {
  if (!filter.caption_query.empty()) throw Error("a caption query can be asked of a database only");
  check_filter(clips, filter);
  std::vector<int64_t> ids;
  for (const Clip& clip : clips) {
    if (clip_matches(clip, filter)) ids.push_back(clip.id);
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace remomask::db
