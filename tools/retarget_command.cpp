#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "tools/output_path.h"
#include "tools/program.h"
#include "tools/reading_options.h"
#include "tools/usage.h"
#include "tools/write_options.h"

namespace remomask::tools {

void register_retarget(CLI::App& app, Program& program) {
  struct Options {
    std::string input, output;
    MotionFileOptions file;
    OutputOptions overwrite;
    WriteOptions writing;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_command(app, "retarget", "put a motion onto your own character",
                  "remomask retarget walk.bvh --character hero.glb -o hero_walk.glb\n"
                  "  remomask retarget wave.glb --character mixamo.fbx -o wave.bvh");
  command->add_option("motion", options->input, "any motion file that convert reads")->required();
  command
      ->add_option("-o,--output", options->output,
                   ".glb (keeps the body of a glTF character) or .bvh (the skeleton alone)")
      ->required();
  options->overwrite.add(*command);
  options->writing.add(*command, "--output-fps");
  command->add_option("--animation", options->file.animation,
                      "name or number (from 0) of the animation of a glTF or FBX motion");
  add_reading_options(*command, options->file);
  command->callback([options, &program] {
    require_writable_output(options->output);
    const MotionWriteOptions writing = options->writing.chosen(options->output);
    if (writing.character.empty()) {
      throw Error("name your figure with --character FILE (.glb, .gltf, .vrm, .fbx or .bvh)");
    }
    options->overwrite.check(options->output, options->input, program);
    const LoadedMotion loaded = load_motion(options->input, options->file);
    const WrittenMotion written = save_motion(options->output, loaded.motion, writing);
    if (program.json) {
      nlohmann::json answer = {{"output", options->output},
                               {"character", writing.character},
                               {"skeleton_map", loaded.skeleton_map},
                               {"warnings", loaded.warnings}};
      add_written(answer, written);
      print_written(written, program);
      return program.print_json(answer);
    }
    for (const std::string& warning : loaded.warnings) program.warn(warning);
    fmt::print("{}: {} at {:g} fps on the skeleton of {}\n", options->output,
               counted(written.frames, "frame"), written.fps, writing.character);
    print_written(written, program);
  });
}

}  // namespace remomask::tools
