// Energies of the cloths of a recording, frame by frame while the page has nothing else to do; as
// playback/export/cloth_energy.cpp, which has put them into an exported page.
import type { ClothMesh } from "./meshes/cloth_mesh";
import type { Metric, Recording } from "./files/recording";

export const KINETIC = "cloth_kinetic_energy_J";
export const HEIGHT = "cloth_height_energy_J";

const SLICE = 8; // [ms] at a time

function energiesOf(recording: Recording, index: number, meshes: ClothMesh[], gravity: number[]): [number, number] {
  const frame = recording.frame(index);
  let kinetic = 0;
  let height = 0;
  for (const [c, mesh] of meshes.entries()) {
    if (recording.topology(c, index)) return [NaN, NaN]; // how a torn node's mass is shared out is not recorded
    const x = frame.positions[c]!;
    const v = frame.velocities[c]!;
    for (let node = 0; node < mesh.masses.length; ++node) {
      const [i, m] = [3 * node, mesh.masses[node]!];
      kinetic += 0.5 * m * (v[i]! * v[i]! + v[i + 1]! * v[i + 1]! + v[i + 2]! * v[i + 2]!);
      height -= m * (gravity[0]! * x[i]! + gravity[1]! * x[i + 1]! + gravity[2]! * x[i + 2]!);
    }
  }
  return [kinetic, height];
}

/** A metric with the values that it has so far. */
function begun(name: string, known: Metric[]): Metric {
  const before = known.find((metric) => metric.name === name);
  return { name, times: [...(before?.times ?? [])], values: [...(before?.values ?? [])] };
}

/** Adds the two metrics to the recording and fills them; progress is told now and then, true at the end. known: those of the
 * same recording when it was shorter. */
export function computeEnergies(
  recording: Recording,
  meshes: ClothMesh[],
  gravity: number[],
  known: Metric[],
  onProgress: (done: boolean) => void,
): { stop: () => void } {
  const kinetic = begun(KINETIC, known);
  const height = begun(HEIGHT, known);
  recording.metrics.push(kinetic, height);
  let next = kinetic.times.length;
  let first = next > 0 ? energiesOf(recording, 0, meshes, gravity)[1] : 0;
  let stopped = false;
  const work = (): void => {
    if (stopped) return;
    const end = performance.now() + SLICE;
    while (next < recording.times.length && performance.now() < end) {
      const [k, h] = energiesOf(recording, next, meshes, gravity);
      if (next === 0) first = h;
      for (const [metric, value] of [[kinetic, k], [height, h - first]] as const) {
        metric.times.push(recording.times[next]!);
        metric.values.push(value);
      }
      next += 1;
    }
    const done = next >= recording.times.length;
    onProgress(done);
    if (!done) window.setTimeout(work);
  };
  window.setTimeout(work);
  return { stop: () => (stopped = true) };
}
