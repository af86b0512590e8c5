// What tests and other programs may ask the page, as window.weft; docs/playback.md describes it.
import type { Player } from "./player";

export interface Hook {
  /** Resolves when the page shows its recordings, or waits for one. */
  ready: Promise<void>;
  /** Names of what is shown. */
  recordings: () => string[];
  /** [s] of the frames of a recording. */
  times: (recording?: number) => number[];
  /** Goes to the frame nearest to a time [s]; gives the time of the frame that is shown. */
  seek: (time: number) => number;
  /** [m], x y z of each node of a body in the frame that is shown; for a rigid body x y z of its centre and x y z w of its turn. */
  positions: (body: string, recording?: number) => number[];
  /** [-], strain of each node of a cloth in the frame that is shown. */
  strain: (body: string, recording?: number) => number[];
  /** What a program has drawn into the frame that is shown: name, kind, and [m] where it is. */
  marks: (recording?: number) => { name: string; kind: string; from: number[]; to: number[] }[];
  /** Three nodes for each triangle of a cloth that is drawn. */
  triangles: (body: string, recording?: number) => number[];
  /** Times [s] and values of a metric. */
  metric: (name: string, recording?: number) => { times: number[]; values: number[] };
  /** [ms] from the drop, or the first byte of a page with recordings, to the first picture. */
  openingTime: () => number;
  notes: () => string[];
}

declare global {
  interface Window {
    weft: Hook;
  }
}

export function makeHook(player: Player, ready: Promise<void>): Hook {
  const recordingOf = (index = 0) => {
    const exhibit = player.exhibits[index];
    if (!exhibit) throw new RangeError(`recording ${index} is not there`);
    return exhibit;
  };
  const find = (name: string, index = 0) => {
    const exhibit = recordingOf(index);
    const { bodies } = exhibit.recording;
    const at = bodies.findIndex((body) => body.name === name);
    const body = bodies[at];
    if (!body) throw new RangeError(`body ${name} is not there`);
    const place = bodies.slice(0, at).filter((other) => other.isCloth === body.isCloth).length;
    const frame = player.frames()[index] ?? 0;
    return { exhibit, at, body, place, frame, data: exhibit.recording.frame(frame) };
  };
  return {
    ready,
    recordings: () => player.exhibits.map(({ recording }) => recording.name),
    times: (index) => [...recordingOf(index).recording.times],
    seek: (time) => {
      player.seek(time);
      return player.time;
    },
    positions: (name, index) => {
      const { body, place, data } = find(name, index);
      return Array.from((body.isCloth ? data.positions : data.poses)[place] ?? []);
    },
    strain: (name, index) => {
      const { place, data } = find(name, index);
      return Array.from(player.strainOf(index ?? 0, place, data.positions[place] ?? []) ?? []);
    },
    marks: (index = 0) =>
      recordingOf(index)
        .recording.marks(player.frames()[index] ?? 0)
        .map(({ name, kind, from, to }) => ({ name, kind, from: [...from], to: [...to] })),
    triangles: (name, index) => {
      const { exhibit, at, place, frame } = find(name, index);
      return Array.from(exhibit.recording.topology(at, frame)?.triangles ?? exhibit.meshes[place]?.triangles ?? []);
    },
    metric: (name, index) => {
      const metric = recordingOf(index).recording.metrics.find((other) => other.name === name);
      return { times: [...(metric?.times ?? [])], values: [...(metric?.values ?? [])] };
    },
    openingTime: () => player.openingTime,
    notes: () => [...document.querySelectorAll(".note")].map((note) => (note.textContent ?? "").trim()),
  };
}
