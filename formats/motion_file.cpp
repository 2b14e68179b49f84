#include "remomask/motion_file.h"

#include <algorithm>
#include <filesystem>

#include "formats/acclaim.h"
#include "formats/amass.h"
#include "formats/bvh.h"
#include "formats/joint_array.h"
#include "formats/mapped_kinematics.h"
#include "formats/motion_reading.h"
#include "formats/motion_writing.h"
#include "formats/npy.h"
#include "formats/source_motion_reading.h"
#include "formats/unread_formats.h"
#include "remomask/error.h"
#include "rig/skeleton_choice.h"
#include "scenes/fbx_reader.h"
#include "scenes/gltf_reader.h"

namespace remomask::formats {

namespace {

constexpr double kAmcFps = 120;

RawMotion read_bvh_motion(const std::string& path, const MotionFileOptions& options) {
  Bvh bvh = read_bvh(path, {.root = options.root, .frame_time_known = options.fps.has_value()});
  check_frame_count(static_cast<size_t>(bvh.frames), path);
  rig::ChosenSkeletonMap chosen =
      rig::choose_skeleton_map(view_of(bvh), options.skeleton_map, path);
  MappedKinematics kinematics(bvh, chosen.map);
  RawMotion raw;
  raw.positions = Motion(bvh.frames, 22);
  raw.rest_pose = Motion(1, 22);
  for (int t = 0; t < bvh.frames; ++t) kinematics.positions(t, raw.positions.at(t, 0));
  kinematics.rest_positions(raw.rest_pose->at(0, 0));
  raw.fps = bvh.frame_time > 0 ? 1 / bvh.frame_time : 0;
  raw.skeleton_map = chosen.map.name;
  raw.warnings = std::move(bvh.warnings);
  raw.warnings.insert(raw.warnings.end(), chosen.warnings.begin(), chosen.warnings.end());
  return raw;
}

RawMotion read_npy_motion(const std::string& path, const MotionFileOptions&) {
  RawMotion raw;
  raw.positions = motion_of_array(read_npy(path), path, raw.warnings);
  raw.fps = humanml_skeleton().fps;
  return raw;
}

/// .npz files may hold joints without saying at what rate, as .npy files do.
RawMotion read_npz_file(const std::string& path, const MotionFileOptions& options) {
  RawMotion raw = read_npz_motion(path);
  if (raw.fps == 0 && !options.fps) {
    raw.fps = humanml_skeleton().fps;
    raw.warnings.push_back(
        "the file states no frame rate: 20 frames a second are taken; give another with --fps");
  }
  return raw;
}

RawMotion read_amc_motion(const std::string& path, const MotionFileOptions& options) {
  AcclaimMotion acclaim = read_amc(path);
  RawMotion raw = load_source_motion(acclaim.source, path, options);
  if (raw.fps == 0 && !options.fps) {
    raw.fps = kAmcFps;
    raw.warnings.push_back(
        "AMC files state no frame rate: 120 frames a second are taken, as in most of CMU; give "
        "another with --fps");
  }
  raw.warnings.insert(raw.warnings.begin(), acclaim.warnings.begin(), acclaim.warnings.end());
  return raw;
}

RawMotion read_gltf_motion(const std::string& path, const MotionFileOptions& options) {
  std::vector<std::string> warnings;
  RawMotion raw =
      load_source_motion(scenes::read_gltf(path, {options.animation}, &warnings), path, options);
  raw.warnings.insert(raw.warnings.begin(), warnings.begin(), warnings.end());
  return raw;
}

RawMotion read_fbx_motion(const std::string& path, const MotionFileOptions& options) {
  std::vector<std::string> warnings;
  RawMotion raw =
      load_source_motion(scenes::read_fbx(path, {options.animation}, &warnings), path, options);
  raw.warnings.insert(raw.warnings.begin(), warnings.begin(), warnings.end());
  return raw;
}

using MotionReader = RawMotion (*)(const std::string& path, const MotionFileOptions& options);

/// Null for a file type that is not read.
MotionReader reader_of(const std::string& extension) {
  if (extension == ".bvh") return read_bvh_motion;
  for (const char* gltf : {".glb", ".gltf", ".vrm", ".vrma"}) {
    if (extension == gltf) return read_gltf_motion;
  }
  if (extension == ".fbx") return read_fbx_motion;
  if (extension == ".npy") return read_npy_motion;
  if (extension == ".npz") return read_npz_file;
  if (extension == ".amc") return read_amc_motion;
  return nullptr;
}

/// Every warning names its file, as errors do.
void name_file(std::vector<std::string>& warnings, const std::string& path) {
  for (std::string& warning : warnings) {
    if (!warning.starts_with(path)) warning = path + ": " + warning;
  }
}

}  // namespace

bool is_readable_motion(const std::string& path) { return reader_of(lower_extension(path)); }

}  // namespace remomask::formats

namespace remomask {

LoadedMotion load_motion(const std::string& path, const MotionFileOptions& options) {
  formats::check_reading_options(options);
  const std::string extension = formats::lower_extension(path);
  const formats::MotionReader read = formats::reader_of(extension);
  if (!read) throw FileError(path, 0, formats::why_unread(extension));
  try {
    LoadedMotion loaded = formats::finish_reading(read(path, options), options);
    formats::name_file(loaded.warnings, path);
    return loaded;
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(path, 0, error.what());
  }
}

WrittenMotion save_motion(const std::string& path, const Motion& motion,
                          const MotionWriteOptions& options) {
  return formats::write_motion(path, motion, nullptr, options);
}

}  // namespace remomask
