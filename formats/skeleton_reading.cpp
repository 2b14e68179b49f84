#include "formats/skeleton_reading.h"

#include "formats/acclaim.h"
#include "formats/bvh.h"
#include "formats/mapped_kinematics.h"
#include "formats/motion_writing.h"
#include "formats/source_motion_reading.h"
#include "remomask/error.h"
#include "scenes/fbx_reader.h"
#include "scenes/gltf_reader.h"

namespace remomask::formats {

rig::SkeletonView read_skeleton(const std::string& path, const MotionFileOptions& options,
                                std::vector<std::string>& warnings) {
  const std::string extension = lower_extension(path);
  if (extension == ".bvh") {
    const Bvh bvh = read_bvh(path, {.root = options.root, .frame_time_known = true});
    warnings.insert(warnings.end(), bvh.warnings.begin(), bvh.warnings.end());
    return view_of(bvh);
  }
  rig::SourceMotion source;
  if (extension == ".amc") {
    source = read_amc(path).source;
  } else if (extension == ".fbx") {
    source = scenes::read_fbx_rig(path, {options.animation}, &warnings);
  } else if (extension == ".glb" || extension == ".gltf" || extension == ".vrm" ||
             extension == ".vrma") {
    scenes::GltfRig rig = scenes::read_gltf_rig(scenes::GltfDocument(path), {options.animation});
    warnings.insert(warnings.end(), rig.warnings.begin(), rig.warnings.end());
    source = std::move(rig.motion);
  } else {
    throw FileError(path, 0,
                    "holds no skeleton that could be shown; skeletons are in .bvh, .glb, .gltf, "
                    ".vrm, .vrma, .fbx and .amc files");
  }
  if (!options.root.empty()) source = keep_skeleton(source, options.root, path);
  return rig::view_of(source);
}

}  // namespace remomask::formats
