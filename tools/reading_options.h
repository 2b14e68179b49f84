#pragma once

#include <optional>
#include <string>

#include "remomask/motion_file.h"
#include "tools/program.h"

namespace remomask::tools {

void add_rate_and_root_options(CLI::App& command, std::optional<double>& fps, std::string& root,
                               const std::string& fps_name);
/// Adds --skeleton-map.
void add_skeleton_map_option(CLI::App& command, std::string& map);

/// Adds --skeleton-map, --fps (or what `fps_name` calls it) and --root to a command that reads
/// motion files with `options`, which has members of these names.
template <typename Options>
void add_reading_options(CLI::App& command, Options& options,
                         const std::string& fps_name = "--fps") {
  add_skeleton_map_option(command, options.skeleton_map);
  add_rate_and_root_options(command, options.fps, options.root, fps_name);
}

/// Reads a motion file; what was odd about it is said on standard error.
Motion load_motion_of_user(const std::string& path, const MotionFileOptions& options,
                           Program& program);

}  // namespace remomask::tools
