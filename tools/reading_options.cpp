#include "tools/reading_options.h"

#include "tools/usage.h"

namespace remomask::tools {

void add_rate_and_root_options(CLI::App& command, std::optional<double>& fps, std::string& root,
                               const std::string& fps_name) {
  command
      .add_option(fps_name, fps,
                  "frames a second of the file, if it states a wrong rate or none (.npy: 20)")
      ->check(positive_number());
  command.add_option("--root", root, "root joint of the skeleton to read, if a file holds several");
}

void add_skeleton_map_option(CLI::App& command, std::string& map) {
  command.add_option("--skeleton-map", map,
                     "a file of maps (\"remomask skeleton\" writes one), which counts for the "
                     "skeletons that it fits, or the name of a built-in map; default: found by the "
                     "joints");
}

Motion load_motion_of_user(const std::string& path, const MotionFileOptions& options,
                           Program& program) {
  LoadedMotion loaded = load_motion(path, options);
  for (const std::string& warning : loaded.warnings) program.warn(warning);
  return std::move(loaded.motion);
}

}  // namespace remomask::tools
