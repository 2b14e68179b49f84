#include "tools/write_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "formats/motion_writing.h"
#include "rig/joint_names.h"
#include "tools/usage.h"

namespace remomask::tools {

namespace {

std::vector<std::string> preset_options() {
  std::vector<std::string> options;
  for (const rig::NamePreset& preset : rig::name_presets()) options.emplace_back(preset.option);
  return options;
}

}  // namespace

void WriteOptions::add(CLI::App& command, const std::string& rate) {
  const std::string group = "Written file";
  command.add_option("--names", names_, "whose names the joints have; default: mixamo")
      ->check(CLI::IsMember(preset_options()))
      ->group(group);
  command
      .add_option(rate, fps_,
                  "frames a second of the written file (24, 25, 30, 60 ..., 1 to 240); default: 20")
      ->check(number_between(1.0, 240.0))
      ->group(group);
  command.add_option("--units", units_, "unit of length, cm or m; default: that of the format")
      ->check(CLI::IsMember({"cm", "m"}))
      ->group(group);
  command
      .add_flag("--in-place", in_place_,
                "leave out the way over the ground: the hips stay above the origin")
      ->group(group);
  command
      .add_flag("--loop", loop_,
                "end in the pose of the first frame; what differs is spread over the last second")
      ->group(group);
  command
      .add_flag("--root-motion", root_motion_,
                "the joint above the hips carries the heading, too, not the position alone")
      ->group(group);
  command
      .add_option("--npz", npz_,
                  "keys of an .npz file: motion (positions, rotations, contacts) or amass")
      ->check(CLI::IsMember({"motion", "amass"}))
      ->group(group);
  command
      .add_flag("--features", features_,
                ".npy: the 263 features of HumanML3D instead of joint positions")
      ->group(group);
  command
      .add_option(
          "--character", character_,
          "put the motion onto your own figure (.glb, .gltf, .vrm, .fbx, .bvh); writes .glb "
          "(keeps the body of a glTF figure) or .bvh")
      ->group(group);
  command
      .add_option("--character-map", character_map_,
                  "skeleton map of the figure, where its joints are not found")
      ->group(group);
}

void WriteOptions::add_own_proportions(CLI::App& command) {
  command
      .add_flag("--own-proportions", own_proportions_,
                "keep the performer's bone lengths; default: those of HumanML3D")
      ->group("Written file");
  command
      .add_flag("--common-skeleton", common_skeleton_,
                "the same skeleton in every file, also for motions whose own pelvis and chest are "
                "rigid and would be kept")
      ->group("Written file");
}

MotionWriteOptions WriteOptions::chosen(const std::string& output) const {
  MotionWriteOptions options;
  for (const rig::NamePreset& preset : rig::name_presets()) {
    if (preset.option == names_) options.names = preset.names;
  }
  if (fps_ > 0) options.fps = fps_;
  if (!units_.empty()) options.units = units_ == "m" ? LengthUnit::metres : LengthUnit::centimetres;
  options.in_place = in_place_;
  options.loop = loop_;
  options.root_motion = root_motion_;
  options.own_proportions = own_proportions_;
  options.common_skeleton = common_skeleton_;
  options.npz = npz_ == "amass" ? NpzLayout::amass : NpzLayout::motion;
  options.features = features_;
  options.character = character_;
  options.character_map = character_map_;
  formats::check_write_options(formats::written_format(output), options);
  return options;
}

void print_written(const WrittenMotion& written, Program& program) {
  for (const std::string& warning : written.warnings) program.warn(warning);
  if (!written.loop) return;
  const LoopGap& gap = *written.loop;
  if (!program.json) {
    fmt::print("  loop closed: {:.0f} degrees and {:.0f} cm, spread over the last {:.2g} s{}\n",
               gap.degrees, 100 * gap.metres, gap.seconds,
               gap.travels ? "; place and heading go on" : "");
  }
  constexpr double kMuch = 60;
  if (gap.degrees > kMuch) {
    program.warn(
        fmt::format("the first and the last pose differ by up to {:.0f} degrees; a motion "
                    "that ends as it begins makes a better loop",
                    gap.degrees));
  }
}

void add_written(nlohmann::json& answer, const WrittenMotion& written) {
  answer["file_frames"] = written.frames;
  answer["file_fps"] = written.fps;
  if (!written.warnings.empty()) answer["character_warnings"] = written.warnings;
  if (!written.loop) return;
  const LoopGap& gap = *written.loop;
  answer["loop"] = {{"degrees", gap.degrees},
                    {"metres", gap.metres},
                    {"travels", gap.travels},
                    {"seconds", gap.seconds}};
}

}  // namespace remomask::tools
