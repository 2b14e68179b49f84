// Whether a figure stands as it should when a three.js page shows its file: on the floor, facing the
// viewer, as tall as a person and as fast as the motion. Runs in node and in a browser.
import {AnimationMixer, Group, SkinnedMesh, Vector3} from 'three';
import {BVHLoader} from 'three/addons/loaders/BVHLoader.js';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';

const HIPS = ['Hips', 'hips'];
const SIDES = [
  ['LeftUpLeg', 'RightUpLeg', 'leftUpperLeg', 'rightUpperLeg'],
  ['LeftArm', 'RightArm', 'leftUpperArm', 'rightUpperArm']];
const FLOOR = 0.03;  // m

// The scene as a page would show it, in metres: a BVH file states no unit.
async function load(name, bytes, metresPerUnit) {
  if (name.endsWith('.bvh')) {
    const {skeleton, clip} = new BVHLoader().parse(new TextDecoder().decode(bytes));
    const scene = new Group();
    scene.add(skeleton.bones[0]);
    scene.scale.setScalar(metresPerUnit);
    return {scene, clip, root: skeleton.bones[0]};
  }
  const gltf = await new GLTFLoader().parseAsync(bytes, '');
  return {scene: gltf.scene, clip: gltf.animations[0], root: gltf.scene};
}

function find(scene, names) {
  const joint = names.map((name) => scene.getObjectByName(name)).find((each) => each);
  if (!joint) throw new Error(`there is no joint ${names.join(' or ')}`);
  return joint;
}

const place = (joint) => joint.getWorldPosition(new Vector3());

// Lowest and highest point of all joints, and of the body where the file has one.
function extent(scene) {
  scene.updateMatrixWorld(true);
  let lowest = Infinity, highest = -Infinity;
  const add = (y) => {
    lowest = Math.min(lowest, y);
    highest = Math.max(highest, y);
  };
  const point = new Vector3();
  scene.traverse((each) => {
    // What lies directly below the scene is the root on the floor, whatever the body does.
    if (!each.isMesh && each !== scene && each.parent !== scene) add(place(each).y);
    if (!(each instanceof SkinnedMesh)) return;
    const count = each.geometry.getAttribute('position').count;
    for (let i = 0; i < count; ++i) {
      add(each.getVertexPosition(i, point).applyMatrix4(each.matrixWorld).y);
    }
  });
  return {lowest, highest};
}

// Degrees by which the body is turned away from +Z.
function turned(scene) {
  const across = new Vector3();
  for (const [left, right, vrmLeft, vrmRight] of SIDES) {
    across.add(place(find(scene, [left, vrmLeft]))).sub(place(find(scene, [right, vrmRight])));
  }
  return Math.atan2(-across.z, across.x) * 180 / Math.PI;
}

const overGround = (a, b) => Math.hypot(b.x - a.x, b.z - a.z);

// name: of the file; bytes: an ArrayBuffer; expected: {frames, fps, hips: [x, y, z, ...]} in metres.
// Returns what was measured and what is wrong.
export async function check(name, bytes, expected, metresPerUnit = 0.01) {
  const {scene, clip, root} = await load(name, bytes, metresPerUnit);
  const problems = [];
  const rest = extent(scene);
  const height = rest.highest - rest.lowest;
  if (!(height >= 1.5 && height <= 1.9)) problems.push(`the figure is ${height} m high`);
  if (!(Math.abs(rest.lowest) <= 0.005)) problems.push(`its rest pose stands at ${rest.lowest} m`);

  const {frames, fps, hips} = expected;
  const seconds = (frames - 1) / fps;
  if (!(Math.abs(clip.duration - seconds) <= 1e-3 * seconds)) {
    problems.push(`it lasts ${clip.duration} s, not ${seconds} s`);
  }
  const mixer = new AnimationMixer(scene);
  mixer.clipAction(clip, root).play();
  const pelvis = find(scene, HIPS);
  let lowest = Infinity, way = 0, wanted = 0, before = null;
  const first = {};
  for (let t = 0; t < frames; ++t) {
    mixer.setTime(Math.min(t / fps, clip.duration - 1e-6));
    const now = extent(scene).lowest;
    if (t === 0) {
      first.lowest = now;
      first.turned = turned(scene);
      first.hips = place(pelvis);
    }
    lowest = Math.min(lowest, now);
    const at = place(pelvis);
    if (before) {
      way += overGround(before, at);
      wanted += Math.hypot(hips[3 * t] - hips[3 * t - 3], hips[3 * t + 2] - hips[3 * t - 1]);
    }
    before = at;
  }
  if (!(Math.abs(first.lowest) <= FLOOR)) problems.push(`it starts ${first.lowest} m off the floor`);
  if (!(lowest >= -FLOOR)) problems.push(`it sinks to ${lowest} m`);
  if (!(Math.abs(first.turned) <= 10)) problems.push(`it starts turned by ${first.turned} degrees`);
  const end = 3 * (frames - 1);
  const moved = overGround(first.hips, before);
  const asked = Math.hypot(hips[end] - hips[0], hips[end + 2] - hips[2]);
  if (!(Math.abs(moved - asked) <= 0.02)) problems.push(`it moves ${moved} m, not ${asked} m`);
  const speed = way / clip.duration, right = wanted / seconds;
  if (!(Math.abs(speed - right) <= 0.02 + 0.03 * right)) {
    problems.push(`it goes at ${speed} m/s, not ${right} m/s`);
  }
  const text = `${name}: ${height.toFixed(2)} m high, starts at ${first.lowest.toFixed(3)} m, ` +
      `lowest ${lowest.toFixed(3)} m, turned ${first.turned.toFixed(1)} degrees, ` +
      `${speed.toFixed(3)} m/s (${right.toFixed(3)}), ${clip.duration.toFixed(2)} s`;
  return {text, problems};
}
