// The arrays of a distance view, decoded; validation/report/formats/distance_view_json.cpp writes them.
import { toNumber } from "../format";
import type { DistanceViewData, QuantizedData } from "../report";

const NOT_FINITE = 65535;
const STEPS = 65534;

function words(base64: string): Uint16Array {
  const bytes = atob(base64);
  const result = new Uint16Array(bytes.length >> 1);
  for (let i = 0; i < result.length; ++i) {
    result[i] = bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8);
  }
  return result;
}

function values(data: QuantizedData): Float64Array {
  const scale = (data.highest - data.lowest) / STEPS;
  return Float64Array.from(words(data.steps_base64), (step) =>
    step === NOT_FINITE ? NaN : data.lowest + step * scale,
  );
}

export interface EngineDistances {
  name: string;
  /** [m] per frame, over all simulated nodes; NaN where the engine has no frame. */
  largest: number[];
  /** [m] per frame and drawn node; empty where the engine has no frame. */
  distances: Float64Array[];
}

export interface DistanceView {
  simulatedNodes: number;
  drawnNodes: number;
  times: number[];
  triangles: Uint16Array;
  positions: Float64Array[];
  engines: EngineDistances[];
  bodies: { shape: string; sizes: number[]; poses: number[][] }[];
}

export function decode(data: DistanceViewData): DistanceView {
  const positions = data.positions.map(values);
  return {
    simulatedNodes: data.simulated_nodes,
    drawnNodes: (positions[0]?.length ?? 0) / 3,
    times: data.times.map(toNumber),
    triangles: words(data.triangles_base64),
    positions,
    engines: data.engines.map((engine) => ({
      name: engine.name,
      largest: engine.largest.map(toNumber),
      distances: engine.distances.map(values),
    })),
    bodies: data.bodies.map((body) => ({
      shape: body.shape,
      sizes: body.sizes.map(toNumber),
      poses: body.poses.map((pose) => pose.map(toNumber)),
    })),
  };
}
