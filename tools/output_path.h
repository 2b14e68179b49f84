#pragma once

#include <CLI/App.hpp>
#include <string>

#include "tools/program.h"

namespace remomask::tools {

/// Before minutes of work: can a motion be stored there at all? Throws Error for
/// an ending that no format has, and for a folder that does not exist.
void require_writable_output(const std::string& output);

/// --force: what a command does where its output exists. Without it, an output that is the input is
/// refused, and any other one is replaced with a note.
struct OutputOptions {
  bool force = false;

  void add(CLI::App& command);
  /// `input` empty: there is none.
  void check(const std::string& output, const std::string& input, Program& program) const;
};

/// The output of sample `i` of `count`: NAME.bvh, or NAME-1.bvh, NAME-2.bvh ...
std::string sample_path(const std::string& output, int i, int count);

}  // namespace remomask::tools
