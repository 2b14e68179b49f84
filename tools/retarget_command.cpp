#include <fmt/format.h>

#include "base/counted.h"
#include "remomask/motion_file.h"
#include "tools/output_path.h"
#include "tools/program.h"
#include "tools/reading_options.h"
#include "tools/usage.h"

namespace remomask::tools {

void register_retarget(CLI::App& app, Program& program) {
  struct Options {
    std::string input, output;
    MotionFileOptions file;
    MotionWriteOptions write;
    OutputOptions overwrite;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_command(app, "retarget", "put a motion onto your own character",
                  "remomask retarget walk.bvh --character hero.glb -o hero_walk.glb\n"
                  "  remomask retarget wave.glb --character mixamo.fbx -o wave.bvh");
  command->add_option("motion", options->input, "any motion file that convert reads")->required();
  command
      ->add_option("--character", options->write.character,
                   ".glb, .gltf, .vrm, .fbx or .bvh: the skeleton, in T-pose or A-pose")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   ".glb (keeps the body of a glTF character) or .bvh (the skeleton alone)")
      ->required();
  options->overwrite.add(*command);
  command->add_option("--skeleton-map", options->file.skeleton_map,
                      "map name or file for the motion");
  command->add_option("--character-map", options->write.character_map,
                      "map name or file for the character");
  command->add_option("--animation", options->file.animation,
                      "name or number of the animation of a glTF or FBX motion");
  add_reading_options(*command, options->file.fps, options->file.root);
  command->callback([options, &program] {
    require_writable_output(options->output);
    options->overwrite.check(options->output, options->input, program);
    const LoadedMotion loaded = load_motion(options->input, options->file);
    const WrittenMotion written = save_motion(options->output, loaded.motion, options->write);
    for (const std::string& warning : loaded.warnings) program.warn(warning);
    for (const std::string& warning : written.warnings) {
      program.warn(options->write.character + ": " + warning);
    }
    if (program.json) {
      return program.print_json({{"output", options->output},
                                 {"character", options->write.character},
                                 {"frames", written.frames},
                                 {"fps", written.fps},
                                 {"skeleton_map", loaded.skeleton_map},
                                 {"warnings", loaded.warnings},
                                 {"character_warnings", written.warnings}});
    }
    fmt::print("{}: {} at {:g} fps on the skeleton of {}\n", options->output,
               counted(written.frames, "frame"), written.fps, options->write.character);
  });
}

}  // namespace remomask::tools
