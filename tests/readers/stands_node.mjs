// node stands_node.mjs MOTION.npy METRES_PER_UNIT FILE...: the files of this motion stand, face the
// viewer and go as stands.mjs says. METRES_PER_UNIT counts for .bvh files.
import {readFileSync} from 'node:fs';
import {basename} from 'node:path';
import {hipsOf} from './npz.mjs';

globalThis.self = globalThis;
globalThis.ProgressEvent ??= class extends Event {};
const {check} = await import('./stands.mjs');
const [npy, metresPerUnit, ...files] = process.argv.slice(2);
const expected = hipsOf(npy);
let failed = false;
for (const path of files) {
  const file = readFileSync(path);
  const bytes = file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength);
  const {text, problems} = await check(basename(path), bytes, expected, Number(metresPerUnit));
  console.log(`three.js: ${text}`);
  problems.forEach((problem) => console.log(`  ${problem}`));
  failed ||= problems.length > 0;
}
process.exit(failed ? 1 : 0);
