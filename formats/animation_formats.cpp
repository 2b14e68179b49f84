#include "formats/animation_formats.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "formats/foot_contacts.h"
#include "formats/npy.h"
#include "formats/npz_writer.h"
#include "formats/sidecar.h"
#include "motion/features.h"
#include "remomask/error.h"
#include "rig/forward_kinematics.h"
#include "rig/written_rotations.h"
#include "scenes/fbx_writer.h"
#include "scenes/gltf_writer.h"

namespace remomask::formats {

namespace {

/// Animations as they go into a file, with what save_motion() says about the first.
struct Animations {
  std::vector<scenes::GltfAnimation> list;
  std::vector<nlohmann::json> extras;
  WrittenMotion written;
};

Animations prepare(const std::vector<WritingJob>& jobs, JointNames names) {
  if (jobs.empty()) throw Error("there is no motion to write");
  Animations result;
  result.extras.resize(jobs.size());
  for (size_t i = 0; i < jobs.size(); ++i) {
    const WritingJob& job = jobs[i];
    MotionWriteOptions writing = job.options;
    // Animations of one file share its skeleton.
    writing.common_skeleton |= jobs.size() > 1;
    rig::RotationsToWrite ready = rig::rotations_to_write(job.motion, writing, names);
    if (i == 0) result.written = ready.written;
    // Contacts are those of the frames in the file.
    result.extras[i] = {{"fps", ready.motion.fps},
                        {"foot_contacts", foot_contacts_json(rig::joint_positions(ready.motion))}};
    if (job.sidecar) result.extras[i]["remomask"] = *job.sidecar;
    rig::choose_signs(ready.motion);
    result.list.push_back({job.name, std::move(ready.motion), &result.extras[i]});
  }
  return result;
}

WrittenFile glb(const std::vector<WritingJob>& jobs) {
  const Animations ready = prepare(jobs, JointNames::mixamo);
  scenes::GltfOptions options;
  options.root_motion = jobs[0].options.root_motion;
  return {scenes::write_gltf(ready.list, options), ready.written};
}

WrittenFile fbx(const std::vector<WritingJob>& jobs) {
  const Animations ready = prepare(jobs, JointNames::mixamo);
  scenes::GltfOptions options;
  options.root_motion = jobs[0].options.root_motion;
  // Blender joins a bone to the tip of the one above it and then drops its path; so the pelvis is
  // the top, as in Mixamo's files, unless the path is wanted on a bone of its own.
  options.root_node = options.root_motion;
  return {scenes::fbx_from_glb(scenes::write_gltf(ready.list, options), ready.written.fps),
          ready.written};
}

WrittenFile write_glb(const WritingJob& job) { return glb({job}); }
WrittenFile write_fbx(const WritingJob& job) { return fbx({job}); }

WrittenFile write_vrma(const WritingJob& job) {
  const Animations ready = prepare({job}, JointNames::vrm);
  scenes::GltfOptions options;
  options.vrm_animation = true;
  return {scenes::write_gltf(ready.list, options), ready.written};
}

WrittenFile write_npz(const WritingJob& job) {
  const rig::RotationsToWrite ready =
      rig::rotations_to_write(job.motion, job.options, JointNames::smpl);
  return {job.options.npz == NpzLayout::amass ? write_amass_npz(ready.motion)
                                              : write_motion_npz(ready.motion),
          ready.written};
}

}  // namespace

const std::vector<MotionFormat>& animation_formats() {
  static const std::vector<MotionFormat> formats = {
      {.extension = ".glb", .units = false, .write = write_glb},
      {.extension = ".vrma", .names = false, .units = false, .write = write_vrma},
      {.extension = ".fbx", .units = false, .write = write_fbx},
      {.extension = ".npz", .units = false, .npz = true, .write = write_npz}};
  return formats;
}

void require_room_for_several(const std::string& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".glb" || extension == ".fbx") return;
  throw Error(
      fmt::format("\"{}\": {} files hold one motion each; several go together into .glb or "
                  ".fbx",
                  path, extension));
}

WrittenMotion write_together(const std::string& path, const std::vector<WritingJob>& jobs) {
  require_room_for_several(path);
  const WrittenFile file = lower_extension(path) == ".glb" ? glb(jobs) : fbx(jobs);
  std::error_code ignored;
  std::filesystem::remove(sidecar_path(path), ignored);
  write_file_atomically(path, file.bytes);
  return file.written;
}

std::string features_bytes(const Motion& motion) {
  const motion::Features features = motion::extract_features_all_frames(
      motion, humanml_skeleton(), motion::FeatureMode::official);
  return format_npy(
      {{static_cast<size_t>(features.frames), static_cast<size_t>(features.dim)}, features.values});
}

}  // namespace remomask::formats
