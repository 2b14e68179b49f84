#include "formats/character.h"

#include <nlohmann/json.hpp>

#include "formats/bvh.h"
#include "formats/foot_contacts.h"
#include "formats/source_bvh.h"
#include "remomask/error.h"
#include "rig/forward_kinematics.h"
#include "rig/retarget.h"
#include "rig/skeleton_choice.h"
#include "rig/skeleton_view.h"
#include "rig/written_rotations.h"
#include "scenes/fbx_reader.h"
#include "scenes/gltf_character.h"
#include "scenes/gltf_reader.h"

namespace remomask::formats {

namespace {

bool is_gltf(const std::string& extension) {
  return extension == ".glb" || extension == ".gltf" || extension == ".vrm";
}

/// The motion without the joint above its pelvis.
JointRotations without_root_joint(const JointRotations& motion) {
  JointRotations result;
  result.frames = motion.frames;
  result.fps = motion.fps;
  result.joint_names.assign(motion.joint_names.begin() + 1, motion.joint_names.end());
  result.rest_offsets.assign(motion.rest_offsets.begin() + 1, motion.rest_offsets.end());
  for (size_t j = 1; j < motion.parents.size(); ++j) {
    result.parents.push_back(motion.parents[j] - 1);
  }
  for (int t = 0; t < motion.frames; ++t) {
    result.root.push_back(rig::from_vec(rig::world_pose(motion, t).positions[1]));
    for (int j = 1; j < motion.joints(); ++j) result.rotations.push_back(motion.rotation(t, j));
  }
  return result;
}

rig::SourceMotion put_onto(const rig::SourceMotion& rig, const WritingJob& job,
                           WrittenMotion& written) {
  const std::string& path = job.options.character;
  MotionWriteOptions writing = job.options;
  // The figure has a pelvis and a chest of its own.
  writing.common_skeleton = true;
  const rig::RotationsToWrite ready = rig::rotations_to_write(job.motion, writing);
  written.frames = ready.written.frames;
  written.fps = ready.written.fps;
  written.loop = ready.written.loop;
  const JointRotations motion = without_root_joint(ready.motion);
  const rig::SkeletonView view = rig::view_of(rig);
  const rig::ChosenSkeletonMap chosen =
      rig::choose_skeleton_map(view, job.options.character_map, path);
  written.warnings.insert(written.warnings.end(), chosen.warnings.begin(), chosen.warnings.end());
  try {
    return rig::retarget(motion, rig, rig::body_joints(chosen.map, view),
                         foot_contacts(rig::joint_positions(motion)));
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(path, 0, error.what());
  }
}

}  // namespace

rig::SourceMotion read_rig(const std::string& path, std::vector<std::string>& warnings) {
  const std::string extension = lower_extension(path);
  if (is_gltf(extension)) {
    scenes::GltfRig rig = scenes::read_gltf_rig(scenes::GltfDocument(path));
    warnings.insert(warnings.end(), rig.warnings.begin(), rig.warnings.end());
    return std::move(rig.motion);
  }
  if (extension == ".fbx") return scenes::read_fbx_rig(path, {}, &warnings);
  if (extension == ".bvh") return rest_of_bvh(read_bvh(path));
  throw FileError(path, 0,
                  "is not a character; characters are read from .glb, .gltf, .vrm, .fbx or .bvh");
}

WrittenFile write_on_character(const WritingJob& job, std::string_view extension) {
  const std::string& path = job.options.character;
  WrittenFile file;
  std::vector<std::string>& warnings = file.written.warnings;
  if (extension != ".glb") {
    const rig::SourceMotion rig = read_rig(path, warnings);
    file.bytes = format_bvh(source_to_bvh(put_onto(rig, job, file.written)));
    return file;
  }
  if (!is_gltf(lower_extension(path))) {
    throw FileError(path, 0,
                    "has no body that a .glb could keep; convert the character to .glb, for "
                    "instance in Blender, or write .bvh");
  }
  const scenes::GltfDocument document(path);
  scenes::GltfRig rig = scenes::read_gltf_rig(document);
  warnings = rig.warnings;
  rig.motion = put_onto(rig.motion, job, file.written);
  nlohmann::json extras = nlohmann::json::object();
  if (job.sidecar) extras["remomask"] = *job.sidecar;
  file.bytes = scenes::character_glb(document, rig, job.name, extras);
  return file;
}

}  // namespace remomask::formats
