// Where a recording takes place: a box around its nodes and bodies in some of its frames.
import { Box3, Vector3, type BufferGeometry } from "three";

import type { Recording } from "../files/recording";

const FRAMES = 9;
/** Farther from the middle of the first frame than so many of its radii nothing counts: a run-away node must not make the others small. */
const REACH = 3;

function addFrame(
  box: Box3,
  recording: Recording,
  index: number,
  geometries: (BufferGeometry | null)[],
  isNear: (place: Vector3) => boolean,
): void {
  const place = new Vector3();
  const frame = recording.frame(index);
  for (const positions of frame.positions) {
    for (let k = 0; k + 2 < positions.length; k += 3) {
      place.set(positions[k]!, positions[k + 1]!, positions[k + 2]!);
      if (isNear(place)) box.expandByPoint(place);
    }
  }
  frame.poses.forEach((pose, r) => {
    const geometry = geometries[r];
    if (!geometry) return;
    if (!geometry.boundingSphere) geometry.computeBoundingSphere();
    const radius = geometry.boundingSphere?.radius ?? 0;
    place.set(pose[0]!, pose[1]!, pose[2]!);
    if (!isNear(place)) return;
    box.expandByPoint(place.clone().addScalar(radius)).expandByPoint(place.clone().addScalar(-radius));
  });
}

export function boundsOf(recording: Recording, geometries: (BufferGeometry | null)[]): Box3 {
  const box = new Box3();
  const count = Math.min(FRAMES, recording.times.length);
  if (count > 0) addFrame(box, recording, 0, geometries, (place) => Number.isFinite(place.length()));
  if (box.isEmpty()) return box.set(new Vector3(-1, -1, -1), new Vector3(1, 1, 1));
  const middle = box.getCenter(new Vector3());
  const reach = Math.max(0.5 * REACH * box.getSize(new Vector3()).length(), 1e-6);
  for (let i = 1; i < count; ++i) {
    const index = Math.round((i * (recording.times.length - 1)) / (count - 1));
    addFrame(box, recording, index, geometries, (place) => place.distanceTo(middle) <= reach);
  }
  return box;
}
