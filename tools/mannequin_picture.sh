#!/bin/sh
# Draws docs/images/mannequin.png: a .glb file as three.js shows it in a headless Chromium, three
# moments of a motion side by side. Needs chromium and node with the npm package three:
#   npm install --prefix FOLDER three
#   tools/mannequin_picture.sh MOTION.glb FOLDER [OUT.png]
set -eu
glb=$1 packages=$2
root=$(cd "$(dirname "$0")/.." && pwd)
out=${3:-$root/docs/images/mannequin.png}
work=$(mktemp -d)
server=
trap 'test -z "$server" || kill "$server"; rm -rf "$work"' EXIT
cp "$glb" "$work/motion.glb"
cp -r "$packages/node_modules/three" "$work/three"
cat > "$work/index.html" <<'PAGE'
<!doctype html>
<style>body { margin: 0; background: #fff }</style>
<script type="importmap">
{"imports": {"three": "./three/build/three.module.js", "three/addons/": "./three/examples/jsm/"}}
</script>
<script type="module">
import * as THREE from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
const width = 900, height = 420, moments = [0, 0.35, 0.7];
const renderer = new THREE.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
renderer.setSize(width, height);
document.body.append(renderer.domElement);
renderer.shadowMap.enabled = true;
renderer.setClearColor(0xffffff);
renderer.setScissorTest(true);
const gltf = await new GLTFLoader().loadAsync('motion.glb');
const scene = new THREE.Scene();
scene.add(gltf.scene, new THREE.HemisphereLight(0xffffff, 0x99a0aa, 2.2));
const sun = new THREE.DirectionalLight(0xffffff, 2.2);
sun.castShadow = true;
scene.add(sun, sun.target);
const floor = new THREE.Mesh(new THREE.PlaneGeometry(60, 60),
                             new THREE.MeshStandardMaterial({color: 0xf2f2f0, roughness: 1}));
floor.rotation.x = -Math.PI / 2;
floor.receiveShadow = true;
scene.add(floor, new THREE.GridHelper(60, 120, 0xd0d0d0, 0xe2e2e2));
gltf.scene.traverse((each) => { each.castShadow = true; each.frustumCulled = false; });
const hips = gltf.scene.getObjectByName('Hips');
const mixer = new THREE.AnimationMixer(gltf.scene);
mixer.clipAction(gltf.animations[0]).play();
const camera = new THREE.PerspectiveCamera(32, width / moments.length / height, 0.1, 50);
moments.forEach((moment, i) => {
  mixer.setTime(moment * gltf.animations[0].duration);
  gltf.scene.updateMatrixWorld(true);
  const at = hips.getWorldPosition(new THREE.Vector3());
  sun.position.set(at.x + 2, 5, at.z + 3);
  sun.target.position.copy(at);
  camera.position.set(at.x + 1.6, 1.5, at.z + 3.4);
  camera.lookAt(at.x, 0.85, at.z);
  const left = Math.round(i * width / moments.length), size = Math.round(width / moments.length);
  renderer.setViewport(left, 0, size, height);
  renderer.setScissor(left, 0, size, height);
  renderer.render(scene, camera);
});
</script>
PAGE
python3 -m http.server --directory "$work" --bind 127.0.0.1 8765 > "$work/log" 2>&1 &
server=$!
sleep 1
chromium --headless --no-sandbox --disable-gpu-sandbox --use-angle=swiftshader \
  --enable-unsafe-swiftshader --user-data-dir="$work/profile" --hide-scrollbars \
  --window-size=900,420 --virtual-time-budget=30000 --screenshot="$out" \
  http://127.0.0.1:8765/index.html > "$work/chromium" 2>&1 || { cat "$work/chromium"; exit 1; }
ls -l "$out"
