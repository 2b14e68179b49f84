#include "formats/motion_writing.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "formats/bvh.h"
#include "formats/inverse_kinematics.h"
#include "formats/npy.h"
#include "remomask/error.h"

namespace remomask::formats {

namespace {

constexpr int kWrittenJoints = 22;

std::string motion_bytes(const std::string& path, const Motion& motion) {
  const std::string extension = lower_extension(path);
  if (extension == ".bvh") return format_bvh(motion_to_bvh(motion));
  if (extension == ".npy") {
    return format_npy({{static_cast<size_t>(motion.frames), kWrittenJoints, 3}, motion.positions});
  }
  throw FileError(path, 0, "is not of a known file type; motions are written as .bvh or .npy");
}

}  // namespace

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

void write_motion(const std::string& path, const Motion& motion, const nlohmann::json* sidecar) {
  if (motion.joints != kWrittenJoints) {
    throw Error(
        fmt::format("only motions of 22 joints can be written, this one has {}", motion.joints));
  }
  const std::string bytes = motion_bytes(path, motion);
  const std::string sidecar_path = path + ".json";
  std::error_code ignored;
  std::filesystem::remove(sidecar_path, ignored);
  write_file_atomically(path, bytes);
  if (!sidecar) return;
  // Text from files may hold bytes that are not UTF-8: shown, not fatal.
  write_file_atomically(
      sidecar_path, sidecar->dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace remomask::formats
