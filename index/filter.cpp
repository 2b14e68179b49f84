#include "index/filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "base/error.h"

namespace remomask {

namespace {

constexpr double kClipFramesPerSecond = 20;  // of Clip::frames

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

void check_filter(const std::vector<Clip>& clips, const ClipFilter& filter) {
  for (const std::string& split : filter.splits) {
    if (split != "train" && split != "val" && split != "test" && split != "none") {
      throw Error("unknown split '" + split + "'; use train, val, test or none");
    }
  }
  if (filter.min_seconds && filter.max_seconds && *filter.min_seconds > *filter.max_seconds) {
    throw Error(fmt::format("the shortest length ({} s) is above the longest ({} s); exchange them",
                            *filter.min_seconds, *filter.max_seconds));
  }
  for (const LabelCondition& condition : filter.labels) {
    const bool known = std::any_of(clips.begin(), clips.end(), [&](const Clip& clip) {
      return find_label(clip.labels, condition.key) != nullptr;
    });
    if (!known) {
      throw Error("no clip has a label '" + condition.key + "'; check the name of the label");
    }
  }
}

bool clip_matches(const Clip& clip, const ClipFilter& filter) {
  if (!filter.splits.empty() &&
      std::find(filter.splits.begin(), filter.splits.end(), clip.split) == filter.splits.end()) {
    return false;
  }
  const double seconds = clip_seconds(clip);
  if (filter.min_seconds && seconds < *filter.min_seconds) return false;
  if (filter.max_seconds && seconds > *filter.max_seconds) return false;
  if (filter.exclude_mirrored && clip.mirrored) return false;
  if (filter.excluded_clips.contains(clip.id)) return false;
  if (filter.excluded_groups.contains(clip.group)) return false;
  return std::all_of(filter.labels.begin(), filter.labels.end(), [&](const auto& condition) {
    const nlohmann::json* label = find_label(clip.labels, condition.key);
    return label && label_equals(*label, condition.value);
  });
}

}  // namespace

LabelCondition parse_label_condition(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw Error("'" + text + "' is no label condition; write key=value, for example content=walk");
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

bool ClipFilter::empty() const {
  return splits.empty() && labels.empty() && !min_seconds && !max_seconds &&
         excluded_groups.empty() && excluded_clips.empty() && !exclude_mirrored;
}

double clip_seconds(const Clip& clip) { return clip.frames / kClipFramesPerSecond; }

std::vector<int64_t> matching_clips(const std::vector<Clip>& clips, const ClipFilter& filter) {
  check_filter(clips, filter);
  std::vector<int64_t> ids;
  for (const Clip& clip : clips) {
    if (clip_matches(clip, filter)) ids.push_back(clip.id);
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace remomask
