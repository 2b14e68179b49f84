#include "rig/skeleton_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <unordered_map>

#include "base/json.h"
#include "remomask/error.h"

namespace remomask::rig {

extern const char* const kShippedSkeletonMaps;

namespace {

using nlohmann::json;
using nlohmann::ordered_json;

MappedPoint parse_point(const json& value) {
  MappedPoint point;
  if (value.is_string()) {
    point.from = value.get<std::string>();
  } else if (value.is_array()) {
    if (value.size() != 3) throw std::invalid_argument("a blend is [\"A\", \"B\", t]");
    point.from = value[0].get<std::string>();
    point.to = value[1].get<std::string>();
    point.weight = value[2].get<double>();
  } else if (value.contains("at")) {
    point.from = value["at"].get<std::string>();
    const auto offset = value.at("offset").get<std::array<double, 3>>();
    point.offset = Vec3(offset[0], offset[1], offset[2]);
    point.weight = 1;
  } else {
    point.from = value.at("end").get<std::string>();
    point.end_site = true;
    point.weight = value.value("t", 1.0);
  }
  return point;
}

ordered_json format_point(const MappedPoint& point) {
  if (!point.to.empty()) return ordered_json::array({point.from, point.to, point.weight});
  if (point.end_site && point.weight == 1) return {{"end", point.from}};
  if (point.end_site) return {{"end", point.from}, {"t", point.weight}};
  if (!point.offset) return point.from;
  const Vec3& offset = *point.offset;
  return {{"at", point.from},
          {"offset", ordered_json::array({offset.x(), offset.y(), offset.z()})}};
}

SkeletonMap parse_map(const std::string& name, const json& value) {
  SkeletonMap map;
  map.name = name;
  const std::vector<std::string>& joints = humanml_skeleton().joint_names;
  for (size_t j = 0; j < joints.size(); ++j) {
    if (!value.contains(joints[j])) {
      throw std::invalid_argument("the map \"" + name + "\" lacks \"" + joints[j] + "\"");
    }
    map.points[j] = parse_point(value[joints[j]]);
  }
  if (value.contains("identify")) {
    map.identify = value["identify"].get<std::vector<std::string>>();
  }
  return map;
}

std::string_view without_namespace(std::string_view name) {
  const size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

/// Joints by name and by name without a namespace like "mixamorig:".
std::unordered_map<std::string, int> joints_by_name(const SkeletonView& skeleton) {
  std::unordered_map<std::string, int> index;
  for (size_t j = 0; j < skeleton.size(); ++j) {
    index.emplace(skeleton.names[j], static_cast<int>(j));
  }
  for (size_t j = 0; j < skeleton.size(); ++j) {
    index.emplace(without_namespace(skeleton.names[j]), static_cast<int>(j));
  }
  return index;
}

/// Names that a map needs, End Sites as "end of A".
std::set<std::string> names_needed(const SkeletonMap& map) {
  std::set<std::string> names(map.identify.begin(), map.identify.end());
  for (const MappedPoint& point : map.points) {
    names.insert(point.from);
    if (!point.to.empty()) names.insert(point.to);
    if (point.end_site) names.insert("end of " + point.from);
  }
  return names;
}

std::set<std::string> names_there(const SkeletonView& skeleton) {
  std::set<std::string> names;
  for (const auto& [name, joint] : joints_by_name(skeleton)) {
    names.insert(name);
    if (skeleton.end_sites[static_cast<size_t>(joint)]) names.insert("end of " + name);
  }
  return names;
}

std::vector<std::string> lacking(const SkeletonMap& map, const std::set<std::string>& there) {
  const std::set<std::string> needed = names_needed(map);
  std::vector<std::string> missing;
  std::set_difference(needed.begin(), needed.end(), there.begin(), there.end(),
                      std::back_inserter(missing));
  return missing;
}

}  // namespace

std::vector<SkeletonMap> parse_skeleton_maps(const std::string& text, const std::string& path) {
  try {
    const json root = parse_json(text);
    std::vector<SkeletonMap> maps;
    if (root.contains("skeletons")) {
      for (const auto& [name, value] : root["skeletons"].items()) {
        maps.push_back(parse_map(name, value));
      }
    } else {
      maps.push_back(parse_map(std::filesystem::path(path).stem().string(), root));
    }
    if (maps.empty()) throw std::invalid_argument("\"skeletons\" is empty");
    return maps;
  } catch (const std::exception& error) {
    throw FileError(path, 0,
                    std::string("is not a skeleton map: ") + error.what() +
                        "; \"remomask skeleton MOTION --write-map FILE\" writes one to begin with");
  }
}

std::string format_skeleton_maps(const std::vector<SkeletonMap>& maps) {
  const std::vector<std::string>& joints = humanml_skeleton().joint_names;
  ordered_json skeletons = ordered_json::object();
  for (const SkeletonMap& map : maps) {
    ordered_json& skeleton = skeletons[map.name];
    if (!map.identify.empty()) skeleton["identify"] = map.identify;
    for (size_t j = 0; j < joints.size(); ++j) skeleton[joints[j]] = format_point(map.points[j]);
  }
  return ordered_json{{"skeletons", skeletons}}.dump(1, ' ', false,
                                                     ordered_json::error_handler_t::replace) +
         "\n";
}

const std::vector<SkeletonMap>& shipped_skeleton_maps() {
  static const std::vector<SkeletonMap> maps =
      parse_skeleton_maps(kShippedSkeletonMaps, "skeleton_maps.json");
  return maps;
}

std::vector<std::string> missing_joints(const SkeletonMap& map, const SkeletonView& skeleton) {
  return lacking(map, names_there(skeleton));
}

const SkeletonMap* fitting_skeleton_map(const std::vector<SkeletonMap>& maps,
                                        const SkeletonView& skeleton) {
  const std::set<std::string> there = names_there(skeleton);
  const SkeletonMap* best = nullptr;
  size_t most = 0;
  for (const SkeletonMap& map : maps) {
    const size_t names = names_needed(map).size();
    if (names > most && lacking(map, there).empty()) {
      best = &map;
      most = names;
    }
  }
  return best;
}

std::array<PlacedPoint, 22> place_points(const SkeletonMap& map, const SkeletonView& skeleton) {
  const auto index = joints_by_name(skeleton);
  const auto joint_named = [&](const std::string& name) {
    const auto found = index.find(name);
    if (found != index.end()) return found->second;
    throw Error(
        fmt::format("the skeleton map \"{}\" names a joint \"{}\", which is not in the "
                    "skeleton",
                    map.name, name));
  };
  std::array<PlacedPoint, 22> placed;
  for (size_t j = 0; j < placed.size(); ++j) {
    const MappedPoint& point = map.points[j];
    PlacedPoint& out = placed[j];
    out.from = joint_named(point.from);
    out.to = point.to.empty() ? out.from : joint_named(point.to);
    out.weight = point.weight;
    if (!point.to.empty()) continue;
    if (point.end_site) {
      const std::optional<Vec3>& end = skeleton.end_sites[static_cast<size_t>(out.from)];
      if (!end) {
        throw Error(
            fmt::format("the skeleton map \"{}\" names the End Site of \"{}\", which has "
                        "none",
                        map.name, point.from));
      }
      out.offset = *end;
    } else {
      out.offset = point.offset.value_or(Vec3::Zero());
    }
  }
  return placed;
}

}  // namespace remomask::rig
