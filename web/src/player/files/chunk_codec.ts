// The two codecs of chunks: that of recordings (docs/recording_format.md) and that of the copy in a page
// (docs/playback.md).
import { decompress } from "fzstd";

import { view } from "./bytes";

/** A frame: all cloths, then all rigid bodies. */
export interface Frame {
  /** [m], x y z of each node, one array for each cloth. */
  positions: (Float32Array | Float64Array)[];
  /** [m/s], likewise; none in the copy of a page. */
  velocities: (Float32Array | Float64Array)[];
  /** Position [m] x y z and orientation x y z w of each rigid body. */
  poses: (Float32Array | Float64Array)[];
}

/** How the scalars of a frame are laid out. */
export interface Layout {
  clothNodes: number[];
  rigids: number;
}

export class DamagedChunk extends Error {}

/** Before compression, as Weft has it: a forged number cannot ask for all memory. */
const MAX_BYTES = 130 * 2 ** 20;

function decompressed(data: Uint8Array, rawBytes: number): Uint8Array {
  if (!(rawBytes >= 0 && rawBytes <= MAX_BYTES)) throw new DamagedChunk(`would have ${rawBytes} bytes: the file is damaged`);
  let bytes: Uint8Array;
  try {
    bytes = decompress(data, new Uint8Array(rawBytes));
  } catch (error) {
    throw new DamagedChunk(`has frames that cannot be decompressed (${String(error)})`);
  }
  if (bytes.length !== rawBytes) throw new DamagedChunk(`has frames of another size than ${rawBytes} bytes: the file is damaged`);
  return bytes;
}

/** Undoes what puts bytes of equal significance side by side. */
export function unshuffled(data: Uint8Array, rawBytes: number, scalarBytes: number): ArrayBuffer {
  const from = decompressed(data, rawBytes);
  const to = new Uint8Array(rawBytes);
  const count = rawBytes / scalarBytes;
  for (let k = 0; k < scalarBytes; ++k) {
    const plane = k * count;
    for (let i = 0, at = k; i < count; ++i, at += scalarBytes) to[at] = from[plane + i]!;
  }
  return to.buffer;
}

const RIGID_SCALARS = 13;
const POSE_SCALARS = 7;

function sum(values: number[]): number {
  return values.reduce((a, b) => a + b, 0);
}

export function decodeFull(data: Uint8Array, rawBytes: number, scalarBytes: number, layouts: Layout[]): Frame[] {
  const buffer = unshuffled(data, rawBytes, scalarBytes);
  const values = scalarBytes === 8 ? new Float64Array(buffer) : new Float32Array(buffer);
  const expected = sum(layouts.map((layout) => 6 * sum(layout.clothNodes) + RIGID_SCALARS * layout.rigids));
  if (expected !== values.length) throw new DamagedChunk(`has ${values.length} numbers in a chunk, expected ${expected}: the file is damaged`);
  let at = 0;
  const take = (count: number): Float32Array | Float64Array => values.subarray(at, (at += count));
  return layouts.map((layout) => {
    const frame: Frame = { positions: [], velocities: [], poses: [] };
    for (const nodes of layout.clothNodes) {
      frame.positions.push(take(3 * nodes));
      frame.velocities.push(take(3 * nodes));
    }
    for (let i = 0; i < layout.rigids; ++i) frame.poses.push(take(RIGID_SCALARS).subarray(0, POSE_SCALARS));
    return frame;
  });
}

/** Stands for a position that is not finite. */
const NO_POSITION = -0x80000000;
const PLANES = 4;

/** Residuals to steps, in place, by the prediction that made them. All arithmetic wraps at 32 bits. */
function undoPrediction(steps: Int32Array[], clothNodes: number[], order: number, byNeighbours: boolean): void {
  steps.forEach((now, f) => {
    if (f === 0 || byNeighbours) {
      let at = 0;
      for (const nodes of clothNodes) {
        for (let axis = 0; axis < 3; ++axis, at += nodes) {
          for (let i = at + 1; i < at + nodes; ++i) now[i] = now[i]! + now[i - 1]!;
        }
      }
    }
    const last = steps[f - 1];
    const before = order === 2 ? steps[f - 2] : undefined;
    if (!last) return;
    for (let i = 0; i < now.length; ++i) {
      now[i] = before ? now[i]! + 2 * last[i]! - before[i]! : now[i]! + last[i]!;
    }
  });
}

export function decodeRounded(data: Uint8Array, rawBytes: number, step: number, layout: Layout, frames: number): Frame[] {
  const bytes = decompressed(data, rawBytes);
  const words = view(bytes);
  const nodes = sum(layout.clothNodes);
  const poseBytes = 4 * POSE_SCALARS * layout.rigids;
  const values = 3 * nodes * frames;
  const begin = 4 + poseBytes * frames;
  if (begin + PLANES * values !== rawBytes) throw new DamagedChunk(`has ${rawBytes} bytes in a chunk, expected ${begin + PLANES * values}: the file is damaged`);
  const residuals = new Int32Array(values);
  for (let i = 0; i < values; ++i) {
    const at = begin + i;
    const zigzag =
      bytes[at]! | (bytes[at + values]! << 8) | (bytes[at + 2 * values]! << 16) | (bytes[at + 3 * values]! << 24);
    residuals[i] = (zigzag >>> 1) ^ -(zigzag & 1);
  }
  const steps = Array.from({ length: frames }, (_, f) => residuals.subarray(3 * nodes * f, 3 * nodes * (f + 1)));
  undoPrediction(steps, layout.clothNodes, bytes[0]!, bytes[1] === 1);
  return steps.map((now, f) => {
    const frame: Frame = { positions: [], velocities: [], poses: [] };
    let at = 0;
    for (const count of layout.clothNodes) {
      const positions = new Float64Array(3 * count);
      for (let axis = 0; axis < 3; ++axis, at += count) {
        for (let i = 0; i < count; ++i) {
          const value = now[at + i]!;
          positions[3 * i + axis] = value === NO_POSITION ? NaN : value * step;
        }
      }
      frame.positions.push(positions);
    }
    for (let r = 0; r < layout.rigids; ++r) {
      const pose = new Float32Array(POSE_SCALARS);
      for (let k = 0; k < POSE_SCALARS; ++k) pose[k] = words.getFloat32(4 + poseBytes * f + 4 * (POSE_SCALARS * r + k), true);
      frame.poses.push(pose);
    }
    return frame;
  });
}
