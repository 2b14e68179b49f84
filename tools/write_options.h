#pragma once

#include <CLI/App.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "remomask/motion_file.h"
#include "tools/program.h"

namespace remomask::tools {

/// How a command writes its motions: what MotionWriteOptions holds, as options of the program.
class WriteOptions {
 public:
  /// `rate`: name of the option for the frame rate. A command that reads motions needs "--fps" for
  /// what it reads.
  void add(CLI::App& command, const std::string& rate = "--fps,--output-fps");
  /// --own-proportions and --common-skeleton, for commands whose motions come from performers.
  void add_own_proportions(CLI::App& command);

  /// Throws Error for a choice that does not apply to the format of `output`.
  MotionWriteOptions chosen(const std::string& output) const;

 private:
  std::string names_, units_, npz_, character_, character_map_;
  double fps_ = 0;
  bool in_place_ = false, loop_ = false, root_motion_ = false, own_proportions_ = false;
  bool common_skeleton_ = false;
  bool features_ = false;
};

/// Says what was closed by --loop and warns where it was much; warns of what was odd about the
/// character. Nothing without these.
void print_written(const WrittenMotion& written, Program& program);

/// Members "file_frames", "file_fps", "loop" and "character_warnings" of an answer in JSON.
void add_written(nlohmann::json& answer, const WrittenMotion& written);

}  // namespace remomask::tools
