#include "formats/source_motion_reading.h"

#include <fmt/format.h>

#include "formats/bvh_scanner.h"
#include "remomask/error.h"
#include "rig/mapped_source.h"
#include "rig/skeleton_choice.h"

namespace remomask::formats {

namespace {

constexpr size_t kMaxShownRoots = 12;

std::string roots_of(const rig::SourceMotion& source) {
  std::vector<std::string> names;
  for (const rig::SourceJoint& joint : source.joints) {
    if (joint.parent < 0 && names.size() < kMaxShownRoots) names.push_back(in_quotes(joint.name));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

rig::SourceMotion keep_skeleton(const rig::SourceMotion& source, const std::string& root,
                                const std::string& path) {
  const int top = source.find_joint(root);
  if (top < 0) {
    throw FileError(path, 0,
                    fmt::format("has no skeleton with the root {}; the roots are {}",
                                in_quotes(root), roots_of(source)));
  }
  // The parents of the root move it: they stay as a chain above it.
  std::vector<bool> kept(source.joints.size(), false);
  for (int j = top; j >= 0; j = source.joints[static_cast<size_t>(j)].parent) {
    kept[static_cast<size_t>(j)] = true;
  }
  std::vector<bool> below(source.joints.size(), false);
  below[static_cast<size_t>(top)] = true;
  for (size_t j = static_cast<size_t>(top) + 1; j < source.joints.size(); ++j) {
    const int parent = source.joints[j].parent;
    below[j] = parent >= 0 && below[static_cast<size_t>(parent)];
    kept[j] = kept[j] || below[j];
  }
  rig::SourceMotion result;
  result.frames = source.frames;
  result.fps = source.fps;
  result.metres_per_unit = source.metres_per_unit;
  result.up_axis = source.up_axis;
  std::vector<int> place(source.joints.size(), -1);
  for (size_t j = 0; j < source.joints.size(); ++j) {
    if (!kept[j]) continue;
    place[j] = static_cast<int>(result.joints.size());
    rig::SourceJoint joint = source.joints[j];
    if (joint.parent >= 0) joint.parent = place[static_cast<size_t>(joint.parent)];
    result.joints.push_back(std::move(joint));
  }
  for (size_t i = 0; i < static_cast<size_t>(source.frames) * source.joints.size(); ++i) {
    if (!kept[i % source.joints.size()]) continue;
    result.rotations.insert(result.rotations.end(), &source.rotations[4 * i],
                            &source.rotations[4 * i] + 4);
    result.translations.insert(result.translations.end(), &source.translations[3 * i],
                               &source.translations[3 * i] + 3);
  }
  return result;
}

RawMotion load_source_motion(const rig::SourceMotion& whole, const std::string& path,
                             const MotionFileOptions& options) {
  rig::SourceMotion chosen;
  if (!options.root.empty()) chosen = keep_skeleton(whole, options.root, path);
  const rig::SourceMotion& source = options.root.empty() ? whole : chosen;
  if (source.frames < 1) throw FileError(path, 0, "holds a skeleton without a motion");
  check_frame_count(static_cast<size_t>(source.frames), path);
  rig::ChosenSkeletonMap map =
      rig::choose_skeleton_map(rig::view_of(source), options.skeleton_map, path);
  rig::MappedSource mapped(source, map.map);
  RawMotion raw;
  raw.positions = Motion(source.frames, 22);
  raw.rest_pose = Motion(1, 22);
  for (int t = 0; t < source.frames; ++t) mapped.positions(t, raw.positions.at(t, 0));
  mapped.positions(-1, raw.rest_pose->at(0, 0));
  raw.fps = source.fps;
  raw.metres_per_unit = source.metres_per_unit;
  raw.up_axis = source.up_axis;
  raw.skeleton_map = map.map.name;
  raw.warnings = std::move(map.warnings);
  return raw;
}

}  // namespace remomask::formats
