"""blender -b --python blender_joints.py -- FILE NPZ: in Blender, every joint of a .glb, .fbx or .bvh
is within a millimetre of the positions in the .npz file of the same motion, and so it is in the
.glb that Blender writes of it."""
import os
import sys
import tempfile

import numpy

# Blender 3.4 of Debian 12 uses names that numpy 1.24 has dropped.
for name, kind in {"bool": bool, "int": int, "float": float, "object": object}.items():
    if not hasattr(numpy, name):
        setattr(numpy, name, kind)

import bpy

JOINTS = ("Hips LeftUpLeg RightUpLeg Spine LeftLeg RightLeg Spine1 LeftFoot RightFoot Spine2 "
          "LeftToeBase RightToeBase Neck LeftShoulder RightShoulder Head LeftArm RightArm "
          "LeftForeArm RightForeArm LeftHand RightHand").split()


def read(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # The rate of the file: Blender writes a key for each frame of its scene, 24 a second if not told.
    bpy.context.scene.render.fps = 20
    if path.endswith(".fbx"):
        bpy.ops.import_scene.fbx(filepath=path)
    elif path.endswith(".bvh"):
        bpy.ops.import_anim.bvh(filepath=path, global_scale=0.01, update_scene_fps=True)
    else:
        bpy.ops.import_scene.gltf(filepath=path)


def worst_joint(positions):
    """In metres, of all frames."""
    figure = next(each for each in bpy.data.objects if each.type == "ARMATURE")
    first, last = figure.animation_data.action.frame_range
    worst = 0
    for t in range(len(positions)):
        frame = first + (last - first) * t / max(1, len(positions) - 1)
        bpy.context.scene.frame_set(int(frame), subframe=frame - int(frame))
        for joint, (x, y, z) in zip(JOINTS, positions[t]):
            place = figure.matrix_world @ figure.pose.bones[joint].head
            difference = numpy.array(place) - (x, -z, y)  # Blender's z is up
            worst = max(worst, float(numpy.linalg.norm(difference)))
    return worst


path, npz = sys.argv[-2:]
positions = numpy.load(npz)["positions"]
read(path)
worst = worst_joint(positions)
again = os.path.join(tempfile.mkdtemp(), "again.glb")
bpy.ops.export_scene.gltf(filepath=again)
read(again)
worst_again = worst_joint(positions)
print(f"{path}: {len(positions)} frames in Blender, worst joint {1000 * worst:.3f} mm, "
      f"written by Blender {1000 * worst_again:.3f} mm")
sys.exit(max(worst, worst_again) > 0.001)
