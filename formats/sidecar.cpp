#include "formats/sidecar.h"

#include <filesystem>

#include "base/bounded_file.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/json.h"
#include "remomask/error.h"

namespace remomask::formats {

namespace {

constexpr uint64_t kMaxSidecar = uint64_t{1} << 26;
constexpr const char* kMotionHash = "motion_hash";
constexpr const char* kChecksum = "checksum";  // of the sidecar without it

/// On one line. Text from files may hold bytes that are not UTF-8: shown, not fatal.
std::string text_of(const nlohmann::json& sidecar, int indent = -1) {
  return sidecar.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::string sidecar_path(const std::string& motion_path) { return motion_path + ".json"; }

void write_sidecar(const std::string& motion_path, nlohmann::json sidecar,
                   std::string_view motion_bytes) {
  sidecar[kMotionHash] = content_hash(motion_bytes);
  sidecar[kChecksum] = content_hash(text_of(sidecar));
  write_file_atomically(sidecar_path(motion_path), text_of(sidecar, 1) + "\n");
}

std::optional<nlohmann::json> read_sidecar(const std::string& motion_path) {
  const std::string path = sidecar_path(motion_path);
  if (!std::filesystem::exists(path)) return std::nullopt;
  try {
    nlohmann::json sidecar = parse_json(read_bounded_file(path, kMaxSidecar));
    const bool other = sidecar.contains(kMotionHash) &&
                       sidecar.at(kMotionHash) != content_hash(read_file(motion_path));
    if (other) {
      throw FileError(path, 0,
                      "was written for another motion than " + motion_path +
                          " is now (the file was changed or replaced); remove one of them");
    }
    if (sidecar.contains(kChecksum)) {
      const nlohmann::json stated = sidecar.at(kChecksum);
      sidecar.erase(kChecksum);
      if (stated != content_hash(text_of(sidecar))) {
        throw FileError(path, 0,
                        "was changed since it was written (its checksum differs); remove it, or "
                        "make the motion again");
      }
    }
    return sidecar;
  } catch (const nlohmann::json::exception& error) {
    throw FileError(path, 0, "is not what generate writes: " + json_reason(error));
  }
}

}  // namespace remomask::formats
