// node bvh_three.mjs FILE.bvh FILE.npz: three.js places every joint of a .bvh in centimetres within a
// millimetre of the positions in the .npz file of the same motion, in its rest pose the figure stands
// on the floor, and time runs at the right speed.
import {readFileSync} from 'node:fs';
import {AnimationMixer, Group, Vector3} from 'three';
import {BVHLoader} from 'three/addons/loaders/BVHLoader.js';
import {readNpz} from './npz.mjs';

const JOINTS = [
  'Hips', 'LeftUpLeg', 'RightUpLeg', 'Spine', 'LeftLeg', 'RightLeg', 'Spine1', 'LeftFoot', 'RightFoot',
  'Spine2', 'LeftToeBase', 'RightToeBase', 'Neck', 'LeftShoulder', 'RightShoulder', 'Head', 'LeftArm',
  'RightArm', 'LeftForeArm', 'RightForeArm', 'LeftHand', 'RightHand'];

const [path, npz] = process.argv.slice(2);
const {skeleton, clip} = new BVHLoader().parse(readFileSync(path, 'utf8'));
const {positions, fps} = readNpz(npz);
const [frames] = positions.shape;
const figure = new Group();
figure.add(skeleton.bones[0]);
const joints = JOINTS.map((name) => skeleton.bones.find((bone) => bone.name === name));
const place = (joint) => joint.getWorldPosition(new Vector3()).divideScalar(100);
const problems = [];

figure.updateMatrixWorld(true);
const heights = joints.map((joint) => place(joint).y);
if (Math.abs(Math.min(...heights)) > 0.005) problems.push('the rest pose is not on the floor');

const seconds = (frames - 1) / fps.values[0];
if (Math.abs(clip.duration - seconds) > 1e-3 * seconds) problems.push(`it lasts ${clip.duration} s`);
const mixer = new AnimationMixer(figure);
mixer.clipAction(clip, skeleton.bones[0]).play();
let worst = 0;
for (let t = 0; t < frames; ++t) {
  mixer.setTime(Math.min(t * clip.duration / (frames - 1), clip.duration - 1e-6));
  figure.updateMatrixWorld(true);
  joints.forEach((joint, j) => {
    const at = (t * 22 + j) * 3;
    worst = Math.max(worst, place(joint).distanceTo(new Vector3(...positions.values.slice(at, at + 3))));
  });
}
if (!(worst <= 0.001)) problems.push(`a joint is ${1000 * worst} mm from where it should be`);
console.log(`three.js: ${path}: ${frames} frames, worst joint ${(1000 * worst).toFixed(3)} mm`);
problems.forEach((problem) => console.log(`  ${problem}`));
process.exit(problems.length ? 1 : 0);
