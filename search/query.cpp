#include "search/query.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "motion/body_parts.h"
#include "motion/canonical.h"
#include "remomask/error.h"
#include "search/sentence.h"

namespace remomask {

namespace {

constexpr std::pair<SearchBy, const char*> kSearchBy[] = {{SearchBy::all, "all"},
                                                          {SearchBy::captions, "captions"},
                                                          {SearchBy::words, "words"},
                                                          {SearchBy::motion, "motion"}};

}  // namespace

const char* search_by_name(SearchBy by) {
  for (const auto& [value, name] : kSearchBy) {
    if (value == by) return name;
  }
  return "";
}

SearchBy parse_search_by(const std::string& name) {
  for (const auto& [value, known] : kSearchBy) {
    if (known == name) return value;
  }
  throw Error("'" + name + "' is nothing to search by; use all, captions, words or motion");
}

}  // namespace remomask

namespace remomask::search {

namespace {

const std::map<std::string, std::vector<int>>& part_groups() {
  static const std::map<std::string, std::vector<int>> groups = [] {
    std::map<std::string, std::vector<int>> names = {
        {"legs", {0, 1}}, {"torso", {2, 3}}, {"arms", {4, 5}}};
    const motion::BodyPartMap& parts = motion::body_parts(humanml_skeleton());
    for (int i = 0; i < motion::kBodyParts; ++i) names[parts.names[static_cast<size_t>(i)]] = {i};
    return names;
  }();
  return groups;
}

void add_scaled(std::vector<float>& sum, const std::vector<float>& vector, double factor) {
  sum.resize(vector.size(), 0.f);
  for (size_t i = 0; i < vector.size(); ++i) sum[i] += static_cast<float>(factor * vector[i]);
}

void check_weight(double weight, const char* name) {
  if (!(weight >= 0 && std::isfinite(weight))) {
    throw Error(
        fmt::format("the weight of the {} is {}; it must be a number from 0 up", name, weight));
  }
}

}  // namespace

std::vector<int> parse_body_parts(const std::vector<std::string>& names) {
  std::set<int> parts;
  for (const std::string& name : names) {
    const auto group = part_groups().find(name);
    if (group == part_groups().end()) {
      std::vector<std::string> known;
      for (const auto& [known_name, members] : part_groups()) known.push_back(known_name);
      throw Error(fmt::format("there is no body part '{}'; use {}", name, fmt::join(known, ", ")));
    }
    parts.insert(group->second.begin(), group->second.end());
  }
  return {parts.begin(), parts.end()};
}

void check_query(const SearchQuery& query) {
  const bool moving = query.motion || !query.like_clip.empty();
  const Sentence sentence = parse_sentence(query.text);
  const bool worded = !sentence.text.empty();
  if (query.k < 1) throw Error("a search returns at least one clip; ask for k of 1 or more");
  if (query.motion && !query.like_clip.empty()) {
    throw Error("the motion to compare with is a file or a stored clip, not both");
  }
  if (!moving && !worded) {
    throw Error(sentence.unwanted.empty()
                    ? "there is nothing to look for: the sentence is empty and no motion is given"
                    : "the sentence says only what is not wanted; say what is, or give a motion");
  }
  if (!moving && !query.parts.empty()) {
    throw Error("body parts are compared with those of a motion; give one (--like, --like-clip)");
  }
  parse_body_parts(query.parts);
  if (query.min_probability) {
    if (!(*query.min_probability >= 0 && *query.min_probability <= 1)) {
      throw Error(fmt::format("{:g} is not a probability; give a number from 0 to 1",
                              *query.min_probability));
    }
    if (moving || query.by == SearchBy::captions || query.by == SearchBy::words) {
      throw Error(
          "probabilities are known of sentences alone, in a search by all or by motion; limit the "
          "similarity instead");
    }
  }
  if (query.moments && !query.parts.empty()) {
    throw Error("moments are found with the whole body; omit the body parts");
  }
  if (!query.boost_words.empty() && asks_by_words(query)) {
    throw Error(
        "a search by words ranks by all words of the sentence; write the words into it, or search "
        "by motion (--by motion)");
  }
  if (query.moments && asks_by_words(query) && query.by == SearchBy::words) {
    throw Error("moments are found by the motion; search by all, captions or motion");
  }
  check_weight(query.boost_weight, "words");
  if (worded && moving) {
    check_weight(query.text_weight, "sentence");
    check_weight(query.motion_weight, "motion");
    if (query.text_weight == 0 && query.motion_weight == 0) {
      throw Error("the weights of sentence and motion are both zero; give one of them weight");
    }
  }
}

Error no_word(const std::string& text) {
  return Error("'" + text + "' holds no word; write letters or digits");
}

bool asks_by_words(const SearchQuery& query) {
  return query.by != SearchBy::motion && !query.motion && query.like_clip.empty();
}

index::LinearQuery linear_query(const QueryVectors& vectors, const SearchQuery& query) {
  const bool both = !vectors.text.empty() && !vectors.motion.empty();
  const double sum = both ? query.text_weight + query.motion_weight : 1;
  const double text_share = both ? query.text_weight / sum : vectors.text.empty() ? 0 : 1;
  const double motion_share = 1 - text_share;
  const std::vector<int> parts = parse_body_parts(query.parts);
  index::LinearQuery result;
  if (text_share > 0) add_scaled(result.global, vectors.text, text_share);
  if (motion_share > 0 && parts.empty()) add_scaled(result.global, vectors.motion, motion_share);
  if (motion_share > 0 && !parts.empty()) {
    result.global.resize(vectors.motion.size(), 0.f);
    result.parts.resize(vectors.motion_parts.size(), 0.f);
    const size_t width = vectors.motion_parts.size() / motion::kBodyParts;
    const double factor = motion_share / static_cast<double>(parts.size());
    for (const int part : parts) {
      const size_t first = static_cast<size_t>(part) * width;
      for (size_t i = first; i < first + width; ++i) {
        result.parts[i] = static_cast<float>(factor * vectors.motion_parts[i]);
      }
    }
  }
  return result;
}

Motion cut_motion(const Motion& motion, double from, const std::optional<double>& to) {
  const double fps = humanml_skeleton().fps, end = motion.frames / fps;
  const double last = to ? std::min(*to, end) : end;
  if (!(from >= 0 && from < last)) {
    throw Error(fmt::format("seconds {:g} to {:g} are no piece of a motion of {:.2f} s", from,
                            to.value_or(end), end));
  }
  const int first_frame = static_cast<int>(std::lround(from * fps));
  const int last_frame = static_cast<int>(std::lround(last * fps));
  if (first_frame >= last_frame) throw Error("the piece of the motion is shorter than one frame");
  return motion::canonicalize(slice(motion, first_frame, last_frame), humanml_skeleton());
}

}  // namespace remomask::search
