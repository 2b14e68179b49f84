#include "rig/skeleton_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/bounded_file.h"
#include "remomask/error.h"
#include "rig/own_skeleton.h"
#include "rig/skeleton_match.h"

namespace remomask::rig {

namespace {

constexpr uint64_t kMaxMapFile = uint64_t{1} << 24;

const SkeletonMap* shipped_map_named(const std::string& name) {
  for (const SkeletonMap& map : shipped_skeleton_maps()) {
    if (map.name == name) return &map;
  }
  return nullptr;
}

std::string names_of_shipped_maps() {
  std::vector<std::string> names;
  for (const SkeletonMap& map : shipped_skeleton_maps()) names.push_back(map.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Why a skeleton was not recognised, with what the user needs to write a map.
std::string refusal(const SkeletonView& skeleton, const SkeletonMatch& match) {
  constexpr size_t kShown = 40;
  const size_t shown = std::min(kShown, skeleton.size());
  std::string names = fmt::format(
      "{}",
      fmt::join(skeleton.names.begin(), skeleton.names.begin() + static_cast<long>(shown), ", "));
  if (skeleton.size() > shown) names += fmt::format(" and {} more", skeleton.size() - shown);
  const std::string reason = match.objection.empty()
                                 ? fmt::format("missing are {}", fmt::join(match.missing, ", "))
                                 : match.objection;
  return fmt::format(
      "no human skeleton was recognised: {}. Its {} joints: {}. If it is human, say in a map file "
      "where our 22 joints are (docs/formats.md) and name it with --skeleton-map",
      reason, skeleton.size(), names);
}

}  // namespace

ChosenSkeletonMap choose_skeleton_map(const SkeletonView& skeleton, const std::string& wanted,
                                      const std::string& path) {
  std::vector<std::string> warnings;
  if (!wanted.empty()) {
    if (const SkeletonMap* map = shipped_map_named(wanted)) {
      const std::vector<std::string> missing = missing_joints(*map, skeleton);
      if (missing.empty()) return {*map, {}};
      throw FileError(path, 0,
                      fmt::format("does not fit the skeleton map \"{}\": it misses {}; leave the "
                                  "map out to have one found",
                                  wanted, fmt::join(missing, ", ")));
    }
    if (!std::filesystem::exists(wanted)) {
      throw Error(fmt::format("there is no skeleton map \"{}\"; name a file or one of {}", wanted,
                              names_of_shipped_maps()));
    }
    const std::vector<SkeletonMap> maps =
        parse_skeleton_maps(read_bounded_file(wanted, kMaxMapFile), wanted);
    if (const SkeletonMap* map = fitting_skeleton_map(maps, skeleton)) return {*map, {}};
    warnings.push_back(fmt::format("no map of {} fits this skeleton: \"{}\" misses {}", wanted,
                                   maps[0].name,
                                   fmt::join(missing_joints(maps[0], skeleton), ", ")));
  }
  if (auto own = own_skeleton_map(skeleton)) return {std::move(*own), std::move(warnings)};
  if (const SkeletonMap* map = fitting_skeleton_map(shipped_skeleton_maps(), skeleton)) {
    return {*map, std::move(warnings)};
  }
  SkeletonMatch match = match_skeleton(skeleton);
  if (!match.map) throw FileError(path, 0, refusal(skeleton, match));
  if (!match.by_names) {
    warnings.push_back(
        "the names of the joints say too little; the skeleton was recognised by its shape: look at "
        "\"remomask skeleton FILE\"");
  }
  return {*std::move(match.map), std::move(warnings)};
}

}  // namespace remomask::rig
