#include <fmt/format.h>

#include "base/counted.h"
#include "formats/motion_writing.h"
#include "remomask/motion_file.h"
#include "tools/output_path.h"
#include "tools/program.h"
#include "tools/reading_options.h"
#include "tools/usage.h"
#include "tools/write_options.h"

namespace remomask::tools {

void register_convert(CLI::App& app, Program& program) {
  struct Options {
    std::string input, output, up_axis;
    double metres_per_unit = 0;
    MotionFileOptions file;
    OutputOptions overwrite;
    WriteOptions writing;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_command(app, "convert", "convert a motion file to 22 joints, on one skeleton",
                  "remomask convert take.bvh joints.npy\n"
                  "  remomask convert 01_10.amc walk.bvh --fps 60 --output-fps 30 --names unreal");
  command
      ->add_option(
          "input", options->input,
          ".bvh, .glb, .gltf, .vrma, .fbx, .amc (its .asf beside it), .npy or .npz (joints, "
          "features, AMASS poses)")
      ->required();
  command->add_option("output", options->output, formats::written_extensions())->required();
  options->overwrite.add(*command);
  options->writing.add(*command, "--output-fps");
  options->writing.add_own_proportions(*command);
  command->add_option("--up-axis", options->up_axis, "X, Y or Z; default: detected")
      ->check(CLI::IsMember({"X", "Y", "Z"}));
  command->add_option("--metres-per-unit", options->metres_per_unit, "default: detected")
      ->check(positive_number());
  add_reading_options(*command, options->file);
  command->add_option("--animation", options->file.animation,
                      "name or number (from 0) of the animation of a glTF or FBX file");
  command->add_option("--skip-frames", options->file.skip_frames, "frames to drop at the start");
  command->callback([options, &program] {
    if (!options->up_axis.empty()) options->file.up_axis = options->up_axis[0];
    if (options->metres_per_unit > 0) options->file.metres_per_unit = options->metres_per_unit;
    const MotionWriteOptions writing = options->writing.chosen(options->output);
    options->file.own_proportions = writing.own_proportions;
    const LoadedMotion loaded = load_motion(options->input, options->file);
    options->overwrite.check(options->output, options->input, program);
    const WrittenMotion written = save_motion(options->output, loaded.motion, writing);
    if (program.json) {
      nlohmann::json answer = {{"output", options->output},
                               {"frames", loaded.motion.frames},
                               {"skeleton_map", loaded.skeleton_map},
                               {"source_fps", loaded.source_fps},
                               {"source_frames", loaded.source_frames},
                               {"metres_per_unit", loaded.metres_per_unit},
                               {"up_axis", std::string(1, loaded.up_axis)},
                               {"warnings", loaded.warnings}};
      add_written(answer, written);
      print_written(written, program);
      return program.print_json(answer);
    }
    for (const std::string& warning : loaded.warnings) program.warn(warning);
    fmt::print("{}: {} at {:g} fps (from {} at {:g} fps, skeleton map {})\n", options->output,
               counted(written.frames, "frame"), written.fps,
               counted(loaded.source_frames, "frame"), loaded.source_fps,
               loaded.skeleton_map.empty() ? "none" : loaded.skeleton_map);
    print_written(written, program);
  });
}

}  // namespace remomask::tools
