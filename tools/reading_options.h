#pragma once

#include <optional>
#include <string>

#include "remomask/motion_file.h"
#include "tools/program.h"

namespace remomask::tools {

/// Adds --fps (or what `fps_name` calls it) and --root to a command that reads motion files.
void add_reading_options(CLI::App& command, std::optional<double>& fps, std::string& root,
                         const std::string& fps_name = "--fps");

/// Adds --skeleton-map.
void add_skeleton_map_option(CLI::App& command, std::string& map);

/// Reads a motion file; what was odd about it is said on standard error.
Motion load_motion_of_user(const std::string& path, const MotionFileOptions& options,
                           Program& program);

}  // namespace remomask::tools
