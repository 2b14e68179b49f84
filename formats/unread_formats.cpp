#include "formats/unread_formats.h"

#include <fmt/format.h>

#include <string_view>

namespace remomask::formats {

namespace {

struct UnreadFormat {
  std::string_view extensions;  ///< each with a blank behind it
  std::string_view reason;
};

constexpr UnreadFormat kUnreadFormats[] = {
    {".c3d .trc .tvd ",
     "holds the positions of markers, without a skeleton: which bone a marker sits on, and where "
     "the "
     "joints are inside of the body, has to be solved first. Solve it in the capture software "
     "(Vicon "
     "Shogun, Motive, MotionBuilder) or with MoSh++ (SOMA), and export BVH, FBX or an AMASS .npz"},
    {".asf .vsk ",
     "is a skeleton without a motion; name the .amc file, which finds its .asf beside it"},
    {".pkl .pickle .pt .pth .joblib ",
     "is a pickle, which runs code when it is loaded; nothing of it was executed. Load it where "
     "you "
     "trust it and save the joints with numpy.save(\"motion.npy\", joints), or poses, trans and "
     "mocap_framerate with numpy.savez"},
    {".blend .ma .mb .max .c4d .hip ",
     "is a scene of a 3D program; export the armature with its animation as GLB, FBX or BVH"},
    {".vmd .pmx ", "is a file of MikuMikuDance; convert it to BVH or FBX, for instance in Blender"},
    {".dae .usd .usda .usdc .usdz .abc .x3d ",
     "is a scene format that is not read; export the armature with its animation as GLB or BVH"},
    {".mp4 .mov .avi .webm .mkv ", "is a video; estimate the motion in it with another program"},
};

}  // namespace

std::string readable_extensions() {
  return ".bvh, .glb, .gltf, .vrma, .fbx, .amc (with its .asf), .npy and .npz";
}

std::string why_unread(const std::string& extension) {
  for (const UnreadFormat& format : kUnreadFormats) {
    if (format.extensions.find(extension + " ") != std::string_view::npos && extension.size() > 1) {
      return fmt::format("{}. Motions are read from {}", format.reason, readable_extensions());
    }
  }
  return fmt::format("has a file type that is not known; motions are read from {}",
                     readable_extensions());
}

}  // namespace remomask::formats
