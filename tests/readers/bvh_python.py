"""python3 bvh_python.py FILE.bvh FILE.npz: the readers bvhio and pybvh place every joint of a .bvh
in centimetres within a millimetre of the positions in the .npz file of the same motion."""
import sys

import bvhio
import numpy
import pybvh

JOINTS = ("Hips LeftUpLeg RightUpLeg Spine LeftLeg RightLeg Spine1 LeftFoot RightFoot Spine2 "
          "LeftToeBase RightToeBase Neck LeftShoulder RightShoulder Head LeftArm RightArm "
          "LeftForeArm RightForeArm LeftHand RightHand").split()
CENTIMETRES = 100
TOLERATED = 0.1


def by_bvhio(path, frames):
    root = bvhio.readAsHierarchy(path)
    joints = {joint.Name: joint for joint, _, _ in root.layout()}
    poses = []
    for frame in range(frames):
        root.loadPose(frame)
        poses.append([list(joints[name].PositionWorld) for name in JOINTS])
    return numpy.array(poses)


def by_pybvh(path, _):
    motion = pybvh.read_bvh_file(path)
    order = [motion.joint_names.index(name) for name in JOINTS]
    return motion.joint_positions()[:, order]


path, npz = sys.argv[1:]
expected = CENTIMETRES * numpy.load(npz)["positions"]
failed = False
for name, read in (("bvhio", by_bvhio), ("pybvh", by_pybvh)):
    there = read(path, len(expected))
    same = there.shape == expected.shape
    worst = numpy.linalg.norm(there - expected, axis=2).max() if same else numpy.inf
    print(f"{name}: {path}: {len(there)} frames, worst joint {10 * worst:.3f} mm")
    failed |= not worst < TOLERATED
sys.exit(failed)
