#include <fmt/format.h>

#include "base/counted.h"
#include "remomask/motion_file.h"
#include "tools/output_path.h"
#include "tools/program.h"
#include "tools/reading_options.h"
#include "tools/usage.h"

namespace remomask::tools {

void register_convert(CLI::App& app, Program& program) {
  struct Options {
    std::string input, output, up_axis;
    double metres_per_unit = 0;
    MotionFileOptions file;
    OutputOptions overwrite;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_command(app, "convert", "convert a motion file to 22 joints at 20 fps, as BVH or npy",
                  "remomask convert take.bvh joints.npy\n"
                  "  remomask convert 01_10.amc walk.bvh --fps 60");
  command
      ->add_option("input", options->input,
                   ".bvh, .amc (its .asf beside it), .npy or .npz (joints, features, AMASS poses)")
      ->required();
  command->add_option("output", options->output, ".bvh or .npy")->required();
  options->overwrite.add(*command);
  command->add_option("--skeleton-map", options->file.skeleton_map, "map name or file");
  command->add_option("--up-axis", options->up_axis, "X, Y or Z; default: detected")
      ->check(CLI::IsMember({"X", "Y", "Z"}));
  command->add_option("--metres-per-unit", options->metres_per_unit, "default: detected")
      ->check(positive_number());
  add_reading_options(*command, options->file.fps, options->file.root);
  command->add_option("--skip-frames", options->file.skip_frames, "frames to drop at the start");
  command->callback([options, &program] {
    if (!options->up_axis.empty()) options->file.up_axis = options->up_axis[0];
    if (options->metres_per_unit > 0) options->file.metres_per_unit = options->metres_per_unit;
    const LoadedMotion loaded = load_motion(options->input, options->file);
    options->overwrite.check(options->output, options->input, program);
    save_motion(options->output, loaded.motion);
    if (program.json) {
      return program.print_json({{"output", options->output},
                                 {"frames", loaded.motion.frames},
                                 {"skeleton_map", loaded.skeleton_map},
                                 {"source_fps", loaded.source_fps},
                                 {"source_frames", loaded.source_frames},
                                 {"metres_per_unit", loaded.metres_per_unit},
                                 {"up_axis", std::string(1, loaded.up_axis)},
                                 {"warnings", loaded.warnings}});
    }
    for (const std::string& warning : loaded.warnings) program.warn(warning);
    fmt::print("{}: {} at 20 fps (from {} at {:g} fps, skeleton map {})\n", options->output,
               counted(loaded.motion.frames, "frame"), counted(loaded.source_frames, "frame"),
               loaded.source_fps, loaded.skeleton_map.empty() ? "none" : loaded.skeleton_map);
  });
}

}  // namespace remomask::tools
