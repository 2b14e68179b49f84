#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace remomask::formats {

/// The file beside a motion that says what it was made from: PATH.json.
std::string sidecar_path(const std::string& motion_path);

/// Writes the sidecar of a motion whose file holds `motion_bytes`. It carries their hash as
/// "motion_hash", so that no motion is ever taken for another one.
void write_sidecar(const std::string& motion_path, nlohmann::json sidecar,
                   std::string_view motion_bytes);

/// The sidecar of a motion; nothing if it has none. Throws FileError for one that is not JSON, or
/// that was written for another motion than now lies beside it (sidecars of version 0.2 and before
/// carry no hash, and are taken as they are).
std::optional<nlohmann::json> read_sidecar(const std::string& motion_path);

}  // namespace remomask::formats
