#include "tools/output_path.h"

#include <fmt/format.h>

#include <filesystem>

#include "formats/motion_writing.h"
#include "remomask/error.h"

namespace remomask::tools {

namespace fs = std::filesystem;

void require_writable_output(const std::string& output) {
  const fs::path path(output);
  formats::written_format(output);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder)) {
    throw Error("output \"" + output + "\": the folder does not exist; create it first");
  }
}

void OutputOptions::add(CLI::App& command) {
  command.add_flag("--force", force,
                   "replace an output that exists without a note, even the input");
}

void OutputOptions::check(const std::string& output, const std::string& input,
                          Program& program) const {
  if (force || !fs::exists(output)) return;
  std::error_code ignored;
  if (!input.empty() && fs::equivalent(input, output, ignored)) {
    throw Error("output \"" + output + "\" is the input; name another file, or add --force");
  }
  program.warn(output + " exists and is replaced");
}

std::string sample_path(const std::string& output, int i, int count) {
  if (count == 1) return output;
  const fs::path path(output);
  return (path.parent_path() /
          fmt::format("{}-{}{}", path.stem().string(), i + 1, path.extension().string()))
      .string();
}

}  // namespace remomask::tools
