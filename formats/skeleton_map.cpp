#include "formats/skeleton_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <unordered_map>

#include "base/json.h"
#include "remomask/error.h"

namespace remomask::formats {

extern const char* const kShippedSkeletonMaps;

namespace {

using nlohmann::json;

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

std::string_view without_prefix(std::string_view name) {
  const size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

/// Joints by name and by name without a prefix like "mixamorig:".
std::unordered_map<std::string, int> joints_by_name(const Bvh& bvh) {
  std::unordered_map<std::string, int> index;
  for (size_t j = 0; j < bvh.joints.size(); ++j) {
    index.emplace(bvh.joints[j].name, static_cast<int>(j));
  }
  for (size_t j = 0; j < bvh.joints.size(); ++j) {
    index.emplace(without_prefix(bvh.joints[j].name), static_cast<int>(j));
  }
  return index;
}

/// The other end of a blend.
BvhPoint blend_target(const Bvh& bvh, const std::unordered_map<std::string, int>& index,
                      const MappedPoint& point) {
  if (!point.to.empty()) return {index.at(point.to), Vec3::Zero()};
  const int joint = index.at(point.from);
  if (point.end_site) return {joint, bvh.joints[joint].end_site.value()};
  return {joint, point.offset.value_or(Vec3::Zero())};
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

std::set<std::string> names_there(const Bvh& bvh) {
  std::set<std::string> names;
  for (const auto& [name, joint] : joints_by_name(bvh)) {
    names.insert(name);
    if (bvh.joints[joint].end_site) names.insert("end of " + name);
  }
  return names;
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
                        "; see formats/skeleton_maps.json for the form");
  }
}

const std::vector<SkeletonMap>& shipped_skeleton_maps() {
  static const std::vector<SkeletonMap> maps =
      parse_skeleton_maps(kShippedSkeletonMaps, "skeleton_maps.json");
  return maps;
}

const SkeletonMap& find_skeleton_map(const std::vector<SkeletonMap>& maps, const Bvh& bvh,
                                     const std::string& path) {
  const std::set<std::string> there = names_there(bvh);
  const SkeletonMap* best = nullptr;
  const SkeletonMap* closest = nullptr;
  size_t most = 0;
  std::vector<std::string> fewest_missing;
  for (const SkeletonMap& map : maps) {
    const std::set<std::string> needed = names_needed(map);
    std::vector<std::string> missing;
    std::set_difference(needed.begin(), needed.end(), there.begin(), there.end(),
                        std::back_inserter(missing));
    if (missing.empty() && needed.size() > most) {
      best = &map;
      most = needed.size();
    }
    if (!closest || missing.size() < fewest_missing.size()) {
      closest = &map;
      fewest_missing = missing;
    }
  }
  if (best) return *best;
  throw FileError(path, 0,
                  fmt::format("no known skeleton has these joint names; the closest, \"{}\", "
                              "misses {}. Write a map file in the form of "
                              "formats/skeleton_maps.json and name it as the skeleton map",
                              closest->name, fmt::join(fewest_missing, ", ")));
}

MappedKinematics::MappedKinematics(const Bvh& bvh, const SkeletonMap& map)
    : kinematics_([&] {
        const auto index = joints_by_name(bvh);
        std::vector<BvhPoint> points;
        for (const MappedPoint& point : map.points) {
          const int from = index.at(point.from);
          points.push_back({from, Vec3::Zero()});
          points.push_back(blend_target(bvh, index, point));
        }
        return BvhKinematics(bvh, std::move(points));
      }()),
      ends_(22 * 6) {
  for (size_t j = 0; j < map.points.size(); ++j) {
    weights_[j] = static_cast<float>(map.points[j].weight);
  }
}

void MappedKinematics::blend(float* out) const {
  for (size_t j = 0; j < weights_.size(); ++j) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const float from = ends_[j * 6 + axis], to = ends_[j * 6 + 3 + axis];
      *out++ = from + weights_[j] * (to - from);
    }
  }
}

void MappedKinematics::positions(int frame, float* out) {
  kinematics_.positions(frame, ends_.data());
  blend(out);
}

void MappedKinematics::rest_positions(float* out) {
  kinematics_.rest_positions(ends_.data());
  blend(out);
}

}  // namespace remomask::formats
