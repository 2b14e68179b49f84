#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/file.h"
#include "drawing/skeleton_drawing.h"
#include "formats/axis_detection.h"
#include "formats/skeleton_reading.h"
#include "remomask/error.h"
#include "rig/skeleton_choice.h"
#include "tools/output_path.h"
#include "tools/program.h"
#include "tools/reading_options.h"
#include "tools/usage.h"

namespace remomask::tools {

namespace {

/// "Hips", "Spine1 + 0.40 to Neck", "end of LeftFoot".
std::string place_in_words(const rig::MappedPoint& point) {
  if (!point.to.empty())
    return fmt::format("{} + {:.2f} to {}", point.from, point.weight, point.to);
  if (point.end_site && point.weight == 1) return "end of " + point.from;
  if (point.end_site) return fmt::format("{} + {:.2f} to its end", point.from, point.weight);
  if (!point.offset) return point.from;
  const Vec3& offset = *point.offset;
  return fmt::format("{} + ({:.4g}, {:.4g}, {:.4g})", point.from, offset.x(), offset.y(),
                     offset.z());
}

std::string how_found(const rig::SkeletonMap& map) {
  return map.name == "rules" ? "found by rules" : fmt::format("skeleton map \"{}\"", map.name);
}

/// Our joints in a pose of the file.
Motion ours_in(const rig::SkeletonPose& pose, const std::array<rig::PlacedPoint, 22>& points) {
  Motion ours(1, 22);
  for (size_t j = 0; j < points.size(); ++j) {
    const auto from = static_cast<size_t>(points[j].from), to = static_cast<size_t>(points[j].to);
    const Vec3 end = pose.positions[to] + pose.rotations[to] * points[j].offset;
    set_joint_position(ours, 0, static_cast<int>(j),
                       pose.positions[from] + points[j].weight * (end - pose.positions[from]));
  }
  return ours;
}

/// Turns file positions into metres, Y up, with the left side at +X.
class Upright {
 public:
  explicit Upright(const Motion& ours)
      : up_axis_(formats::detect_up_axis(ours, &ours)),
        metres_(formats::detect_metres_per_unit(ours)) {
    Motion turned = ours;
    formats::turn_up_axis(turned, up_axis_);
    const Vec3 left = joint_position(turned, 0, 1) - joint_position(turned, 0, 2);
    heading_ = std::atan2(left.z(), left.x());
  }

  Vec3 operator()(const Vec3& point) const {
    Motion one(1, 1);
    set_joint_position(one, 0, 0, point * metres_);
    formats::turn_up_axis(one, up_axis_);
    return Eigen::AngleAxisd(heading_, Vec3::UnitY()) * joint_position(one, 0, 0);
  }

 private:
  char up_axis_;
  double metres_, heading_ = 0;
};

drawing::SkeletonPicture picture_of(const rig::SkeletonView& skeleton,
                                    const rig::SkeletonMap& map) {
  const std::array<rig::PlacedPoint, 22> points = rig::place_points(map, skeleton);
  drawing::SkeletonPicture picture;
  picture.ours = ours_in(skeleton.first, points);
  const Upright upright(picture.ours);
  for (int j = 0; j < picture.ours.joints; ++j) {
    set_joint_position(picture.ours, 0, j, upright(joint_position(picture.ours, 0, j)));
    picture.labels.push_back(place_in_words(map.points[static_cast<size_t>(j)]));
  }
  for (const Vec3& position : skeleton.first.positions) picture.joints.push_back(upright(position));
  picture.parents = skeleton.parents;
  return picture;
}

}  // namespace

void register_skeleton(CLI::App& app, Program& program) {
  struct Options {
    std::string input, picture, map_file;
    MotionFileOptions reading;
    OutputOptions overwrite;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = add_command(
      app, "skeleton", "show which joints of a file are taken for which of the 22",
      "remomask skeleton take.bvh --picture take.png\n"
      "  remomask skeleton take.bvh --write-map take.json    # to edit, for --skeleton-map");
  command->add_option("input", options->input, "a file with a skeleton (.bvh, .glb, .fbx, .amc)")
      ->required();
  add_skeleton_map_option(*command, options->reading.skeleton_map);
  command->add_option("--root", options->reading.root,
                      "root joint of the skeleton to read, if a file holds several");
  command->add_option("--picture", options->picture, "draw the skeleton and what was found (.png)");
  command->add_option("--write-map", options->map_file,
                      "write what was found as a map file (.json), to be edited");
  options->overwrite.add(*command);
  command->callback([options, &program] {
    std::vector<std::string> warnings;
    const rig::SkeletonView skeleton =
        formats::read_skeleton(options->input, options->reading, warnings);
    rig::ChosenSkeletonMap chosen =
        rig::choose_skeleton_map(skeleton, options->reading.skeleton_map, options->input);
    warnings.insert(warnings.end(), chosen.warnings.begin(), chosen.warnings.end());
    if (!options->picture.empty()) {
      if (std::filesystem::path(options->picture).extension() != ".png") {
        throw Error("picture \"" + options->picture + "\": pictures are PNG files; end it in .png");
      }
      options->overwrite.check(options->picture, options->input, program);
      drawing::SkeletonPicture picture = picture_of(skeleton, chosen.map);
      picture.title = std::filesystem::path(options->input).filename().string();
      picture.subtitle = fmt::format("{}; {} joints in the file, first frame",
                                     how_found(chosen.map), skeleton.size());
      drawing::write_skeleton_picture(options->picture, picture);
    }
    if (!options->map_file.empty()) {
      options->overwrite.check(options->map_file, options->input, program);
      rig::SkeletonMap map = chosen.map;
      map.name = std::filesystem::path(options->map_file).stem().string();
      write_file_atomically(options->map_file, rig::format_skeleton_maps({map}));
    }
    const std::vector<std::string>& ours = humanml_skeleton().joint_names;
    if (program.json) {
      nlohmann::json found = nlohmann::json::object();
      for (size_t j = 0; j < ours.size(); ++j) {
        found[ours[j]] = place_in_words(chosen.map.points[j]);
      }
      return program.print_json({{"file", options->input},
                                 {"skeleton_map", chosen.map.name},
                                 {"found", found},
                                 {"joints", skeleton.names},
                                 {"warnings", warnings}});
    }
    for (const std::string& warning : warnings) program.warn(options->input + ": " + warning);
    fmt::print("{}: {} joints, {}\n", options->input, skeleton.size(), how_found(chosen.map));
    for (size_t j = 0; j < ours.size(); ++j) {
      fmt::print("  {:<15} {}\n", ours[j], place_in_words(chosen.map.points[j]));
    }
  });
}

}  // namespace remomask::tools
