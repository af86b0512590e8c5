// Where a recording takes place: a box around its nodes and bodies in some of its frames.
import { Box3, Vector3, type BufferGeometry } from "three";

import type { Recording } from "./recording";

const FRAMES = 9;

export function boundsOf(recording: Recording, geometries: (BufferGeometry | null)[]): Box3 {
  const box = new Box3();
  const place = new Vector3();
  const count = Math.min(FRAMES, recording.times.length);
  for (let i = 0; i < count; ++i) {
    const frame = recording.frame(Math.round((i * (recording.times.length - 1)) / Math.max(count - 1, 1)));
    for (const positions of frame.positions) {
      for (let k = 0; k + 2 < positions.length; k += 3) {
        place.set(positions[k]!, positions[k + 1]!, positions[k + 2]!);
        // A blown-up node must not hide the others.
        if (place.length() < 1e4) box.expandByPoint(place);
      }
    }
    frame.poses.forEach((pose, r) => {
      const geometry = geometries[r];
      if (!geometry) return;
      if (!geometry.boundingSphere) geometry.computeBoundingSphere();
      const radius = geometry.boundingSphere?.radius ?? 0;
      place.set(pose[0]!, pose[1]!, pose[2]!);
      if (!(place.length() < 1e4)) return;
      box.expandByPoint(place.clone().addScalar(radius)).expandByPoint(place.clone().addScalar(-radius));
    });
  }
  if (box.isEmpty()) box.set(new Vector3(-1, -1, -1), new Vector3(1, 1, 1));
  return box;
}
