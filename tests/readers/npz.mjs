// Reads .npy files, and .npz files, which are zip archives of them.
import {readFileSync} from 'node:fs';
import {inflateRawSync} from 'node:zlib';

function array(bytes) {
  const headerLength = bytes.readUInt16LE(8);
  const header = bytes.toString('latin1', 10, 10 + headerLength);
  const type = /'descr': '([^']+)'/.exec(header)[1];
  const shape = /'shape': \(([^)]*)\)/.exec(header)[1].split(',').filter((n) => n.trim()).map(Number);
  const body = bytes.subarray(10 + headerLength);
  const count = shape.reduce((product, n) => product * n, 1);
  const values = [];
  for (let i = 0; i < count; ++i) {
    if (type === '<f4') values.push(body.readFloatLE(4 * i));
    else if (type === '<f8') values.push(body.readDoubleLE(8 * i));
  }
  return {type, shape, values};
}

export function readNpz(path) {
  const zip = readFileSync(path);
  const end = zip.lastIndexOf(Buffer.from('PK\x05\x06', 'latin1'));
  const entries = {};
  let at = zip.readUInt32LE(end + 16);
  for (let i = 0; i < zip.readUInt16LE(end + 10); ++i) {
    const method = zip.readUInt16LE(at + 10), size = zip.readUInt32LE(at + 20);
    const nameLength = zip.readUInt16LE(at + 28), local = zip.readUInt32LE(at + 42);
    const name = zip.toString('utf8', at + 46, at + 46 + nameLength).replace('.npy', '');
    const start = local + 30 + zip.readUInt16LE(local + 26) + zip.readUInt16LE(local + 28);
    const packed = zip.subarray(start, start + size);
    entries[name] = array(method === 8 ? inflateRawSync(packed) : packed);
    at += 46 + nameLength + zip.readUInt16LE(at + 30) + zip.readUInt16LE(at + 32);
  }
  return entries;
}

// Where the hips are in a .npy file of [frames][22][3] positions at 20 frames a second.
export function hipsOf(path) {
  const {shape: [frames, joints], values} = array(readFileSync(path));
  const hips = [];
  for (let t = 0; t < frames; ++t) hips.push(...values.slice(3 * joints * t, 3 * joints * t + 3));
  return {frames, fps: 20, hips};
}
