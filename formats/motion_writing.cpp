#include "formats/motion_writing.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "formats/animation_formats.h"
#include "formats/bvh_motion.h"
#include "formats/character.h"
#include "formats/npy.h"
#include "formats/sidecar.h"
#include "motion/canonical.h"
#include "remomask/error.h"
#include "rig/written_rotations.h"

namespace remomask::formats {

namespace {

constexpr int kWrittenJoints = 22;
constexpr double kCentimetresPerMetre = 100;

WrittenFile write_bvh(const WritingJob& job) {
  const rig::RotationsToWrite ready = rig::rotations_to_write(job.motion, job.options);
  const bool metres = job.options.units == LengthUnit::metres;
  return {format_bvh(rotations_to_bvh(ready.motion, metres ? 1 : kCentimetresPerMetre)),
          ready.written};
}

WrittenFile write_npy(const WritingJob& job) {
  const double fps = job.options.fps.value_or(job.motion.fps);
  const Motion motion = motion::resample(job.motion, job.motion.fps, fps);
  WrittenMotion written;
  written.frames = motion.frames;
  written.fps = fps;
  if (job.options.features) return {features_bytes(motion), written};
  return {format_npy({{static_cast<size_t>(motion.frames), kWrittenJoints, 3}, motion.positions}),
          written};
}

}  // namespace

const std::vector<MotionFormat>& written_formats() {
  static const std::vector<MotionFormat> formats = [] {
    std::vector<MotionFormat> all = {{.extension = ".bvh", .write = write_bvh},
                                     {.extension = ".npy",
                                      .rotations = false,
                                      .names = false,
                                      .units = false,
                                      .features = true,
                                      .write = write_npy}};
    all.insert(all.end(), animation_formats().begin(), animation_formats().end());
    return all;
  }();
  return formats;
}

std::string written_extensions() {
  const std::vector<MotionFormat>& formats = written_formats();
  std::string text;
  for (size_t i = 0; i < formats.size(); ++i) {
    if (i > 0) text += i + 1 < formats.size() ? ", " : " or ";
    text += formats[i].extension;
  }
  return text;
}

const MotionFormat& written_format(const std::string& path) {
  const std::string extension = lower_extension(path);
  for (const MotionFormat& format : written_formats()) {
    if (format.extension == extension) return format;
  }
  throw FileError(path, 0,
                  "is not of a known file type; motions are written as " + written_extensions());
}

void check_write_options(const MotionFormat& format, const MotionWriteOptions& options) {
  const auto refuse = [&](bool chosen, bool used, const char* what) {
    if (!chosen || used) return;
    throw Error(
        fmt::format("{} has no meaning for {} files; leave it out, or write a file of "
                    "another kind",
                    what, format.extension));
  };
  refuse(options.names.has_value(), format.names, "--names (joint names)");
  refuse(options.units.has_value(), format.units, "--units (unit of length)");
  refuse(options.in_place, format.rotations, "--in-place");
  refuse(options.loop, format.rotations, "--loop");
  refuse(options.root_motion, format.rotations, "--root-motion");
  refuse(options.own_proportions, format.rotations, "--own-proportions");
  refuse(options.common_skeleton, format.rotations, "--common-skeleton");
  const bool figure = !options.character.empty();
  refuse(figure, format.extension == ".bvh" || format.extension == ".glb", "--character");
  refuse(figure && options.names, false, "--names together with --character");
  refuse(figure && options.units, false, "--units together with --character");
  refuse(figure && options.root_motion, false, "--root-motion together with --character");
  refuse(options.npz != NpzLayout::motion, format.npz, "--npz amass");
  refuse(options.features, format.features, "--features");
  if (options.fps && !(*options.fps >= 1 && *options.fps <= 240)) {
    throw Error(
        fmt::format("a motion is written at 1 to 240 frames a second, not at {:g}", *options.fps));
  }
}

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

WrittenMotion write_motion(const std::string& path, const Motion& motion,
                           const nlohmann::json* sidecar, const MotionWriteOptions& options) {
  if (motion.joints != kWrittenJoints) {
    throw Error(
        fmt::format("only motions of 22 joints can be written, this one has {}", motion.joints));
  }
  const MotionFormat& format = written_format(path);
  check_write_options(format, options);
  const WritingJob job{motion, options, sidecar, std::filesystem::path(path).stem().string()};
  const WrittenFile file =
      options.character.empty() ? format.write(job) : write_on_character(job, format.extension);
  std::error_code ignored;
  std::filesystem::remove(sidecar_path(path), ignored);
  write_file_atomically(path, file.bytes);
  if (sidecar) write_sidecar(path, *sidecar, file.bytes);
  return file.written;
}

}  // namespace remomask::formats
