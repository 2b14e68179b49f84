// node gltf_three.mjs FILE.glb FILE.npz: in three.js, the figure plays so that every joint is within
// a millimetre of the positions in the .npz file of the same motion, stands on the floor and faces +Z.
import {readFileSync} from 'node:fs';
import {AnimationMixer, Vector3} from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {readNpz} from './npz.mjs';

const MIXAMO = [
  'Hips', 'LeftUpLeg', 'RightUpLeg', 'Spine', 'LeftLeg', 'RightLeg', 'Spine1', 'LeftFoot', 'RightFoot',
  'Spine2', 'LeftToeBase', 'RightToeBase', 'Neck', 'LeftShoulder', 'RightShoulder', 'Head', 'LeftArm',
  'RightArm', 'LeftForeArm', 'RightForeArm', 'LeftHand', 'RightHand'];
const VRM = [
  'hips', 'leftUpperLeg', 'rightUpperLeg', 'spine', 'leftLowerLeg', 'rightLowerLeg', 'chest', 'leftFoot',
  'rightFoot', 'upperChest', 'leftToes', 'rightToes', 'neck', 'leftShoulder', 'rightShoulder', 'head',
  'leftUpperArm', 'rightUpperArm', 'leftLowerArm', 'rightLowerArm', 'leftHand', 'rightHand'];

globalThis.self = globalThis;
globalThis.ProgressEvent ??= class extends Event {};
const [glb, npz] = process.argv.slice(2);
const file = readFileSync(glb);
const gltf = await new GLTFLoader().parseAsync(
    file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength), '');
const {positions, fps} = readNpz(npz);
const names = gltf.scene.getObjectByName('Hips') ? MIXAMO : VRM;
const joints = names.map((name) => gltf.scene.getObjectByName(name));
const place = (joint) => joint.getWorldPosition(new Vector3());
const problems = [];

gltf.scene.updateMatrixWorld(true);
const rest = joints.map(place);
const height = Math.max(...rest.map((p) => p.y)), lowest = Math.min(...rest.map((p) => p.y));
if (Math.abs(lowest) > 0.005) problems.push(`the rest pose stands ${lowest} m off the floor`);
if (height < 1.3 || height > 1.8) problems.push(`the head joint is ${height} m high`);
if (rest[10].z - rest[7].z < 0.05) problems.push('the toes do not point to +Z');
if (rest[16].x < rest[17].x) problems.push('the left arm is not on the side of +X');

const mixer = new AnimationMixer(gltf.scene);
mixer.clipAction(gltf.animations[0]).play();
const [frames] = positions.shape;
let worst = 0;
for (let t = 0; t < frames; ++t) {
  mixer.setTime(Math.min(t / fps.values[0], gltf.animations[0].duration - 1e-6));
  gltf.scene.updateMatrixWorld(true);
  joints.forEach((joint, j) => {
    const at = (t * 22 + j) * 3;
    worst = Math.max(worst, place(joint).distanceTo(new Vector3(...positions.values.slice(at, at + 3))));
  });
}
if (worst > 0.001) problems.push(`a joint is ${1000 * worst} mm from where it should be`);
console.log(`${glb}: ${frames} frames, worst joint ${(1000 * worst).toFixed(3)} mm`);
problems.forEach((problem) => console.log(`  ${problem}`));
process.exit(problems.length ? 1 : 0);
