#pragma once

#include <optional>
#include <string>
#include <vector>

#include "remomask/export.h"
#include "remomask/generation.h"
#include "remomask/motion.h"

namespace remomask {

struct MotionFileOptions {
  std::optional<double> metres_per_unit;  ///< unset: guessed from the size of the skeleton
  std::optional<char> up_axis;  ///< 'X', 'Y' or 'Z'; unset: found from the rest of the body
  int skip_frames = 0;          ///< frames to drop at the start, at the file's rate
  /// Frames a second of the file; unset: what the file states. For files that state a wrong rate
  /// or none.
  std::optional<double> fps;
  /// Name of the root joint of the skeleton to read, for files that hold several.
  std::string root;
  /// Name or number (from 0) of the animation of a .glb, .gltf or .fbx file; empty: the first.
  std::string animation;
  /// false: place, heading, floor and size of the body stay as in the file; only unit, up axis
  /// and frame rate change. What is in metres, Y up and at 20 fps is then read as it is.
  bool canonical = true;
  /// Canonical motions have the bone lengths of HumanML3D; true: they keep those of the performer.
  bool own_proportions = false;
  /// Name of a shipped skeleton map or path of a map file; empty: found by joint names.
  std::string skeleton_map;
};

struct LoadedMotion {
  Motion motion;             ///< 22 joints at 20 fps, canonical unless asked for otherwise
  std::string skeleton_map;  ///< the map that was used; empty for .npy
  double source_fps = 0;
  int source_frames = 0;
  double metres_per_unit = 0;
  char up_axis = 'Y';
  /// What was odd about the file and how it was read all the same: "PATH:LINE: sentence".
  std::vector<std::string> warnings;
};

/// Reads a motion file by its extension: .bvh, .glb, .gltf, .vrm, .vrma, .fbx, .amc with its .asf,
/// .npy and .npz (joints, features or AMASS poses). Throws FileError with the line and a remedy.
REMOMASK_API LoadedMotion load_motion(const std::string& path,
                                      const MotionFileOptions& options = {});

/// Whose names the joints of a written file have. All but smpl are names without a prefix:
/// "Hips", not "mixamorig:Hips".
enum class JointNames { mixamo, unreal, unity, vrm, godot, smpl };

enum class LengthUnit { centimetres, metres };

/// Keys of an .npz file: positions, rotations and contacts, or those of AMASS.
enum class NpzLayout { motion, amass };

/// How a motion is written. A choice that a format has no use for is an Error.
struct MotionWriteOptions {
  std::optional<JointNames> names = {};  ///< unset: those of the format, else mixamo
  /// 1 to 240; unset: the motion's own. Rotations are interpolated on the sphere, and feet that
  /// stand go on standing.
  std::optional<double> fps = {};
  std::optional<LengthUnit> units = {};  ///< unset: those of the format; centimetres in .bvh
  bool in_place = false;                 ///< the body stays above the origin; heights are kept
  /// The last frame becomes the first one: what differs is spread over the end of the motion.
  bool loop = false;
  bool root_motion = false;      ///< the heading lies on the joint "Root", too, not on the hips
  bool own_proportions = false;  ///< as in RotationOptions
  /// All motions get the same skeleton. Otherwise one that is rigid keeps its shapes of pelvis and
  /// chest (RotationOptions::keep_rigid), unless a file holds several motions.
  bool common_skeleton = false;
  NpzLayout npz = NpzLayout::motion;
  bool features = false;  ///< .npy: the 263 features of HumanML3D instead of positions
  /// A figure of the user's own (.glb, .gltf, .vrm, .bvh, .fbx) that the motion is put onto: a .glb
  /// keeps its body, other figures give a .bvh of their skeleton. Empty: none.
  std::string character = {};
  std::string character_map = {};  ///< skeleton map of the figure, as MotionFileOptions has it
};

/// What was closed by MotionWriteOptions::loop.
struct LoopGap {
  double degrees = 0;    ///< largest difference of a joint's rotation
  double metres = 0;     ///< difference of the height, and of the place if that was closed, too
  bool travels = false;  ///< the motion ends elsewhere: place and heading go on from cycle to cycle
  double seconds = 0;    ///< of the stretch that the difference was spread over
};

struct WrittenMotion {
  int frames = 0;
  double fps = 0;
  std::optional<LoopGap> loop;
  std::vector<std::string> warnings;  ///< about the figure that the motion was put onto
};

/// Writes .bvh (joint rotations over a T-pose), .glb (the same with a body), .vrma, .fbx, .npz or
/// .npy (float32 T x 22 x 3, metres), chosen by extension. The file is replaced atomically, and an
/// old sidecar is removed.
REMOMASK_API WrittenMotion save_motion(const std::string& path, const Motion& motion,
                                       const MotionWriteOptions& options = {});

/// The same, and beside it PATH.json with the sentence, seed, evidence and settings that the
/// motion was made with (docs/schema/motion.json).
REMOMASK_API WrittenMotion save_motion(const std::string& path, const GeneratedMotion& made,
                                       const MotionWriteOptions& options = {});
REMOMASK_API WrittenMotion save_motion(const std::string& path, const EditedMotion& made,
                                       const MotionWriteOptions& options = {});
REMOMASK_API WrittenMotion save_motion(const std::string& path, const ScriptedMotion& made,
                                       const MotionWriteOptions& options = {});

}  // namespace remomask
