// A mesh inside the resolved scene, as scenes/format/mesh_text.cpp writes it.
import { fromBase64, view } from "../files/bytes";

const MAGIC = "WEFTMESH";

export function storedMesh(text: string): { rest: Float64Array; triangles: Uint32Array; cornerPlaces: Float32Array } {
  const bytes = fromBase64(text);
  const words = view(bytes);
  if (String.fromCharCode(...bytes.subarray(0, MAGIC.length)) !== MAGIC) throw new Error("a stored mesh is damaged");
  const [nodes, triangles, places] = [8, 12, 16].map((at) => words.getUint32(at, true)) as [number, number, number];
  let at = 20;
  const reals = (count: number): number[] =>
    Array.from({ length: count }, () => words.getFloat64((at += 8) - 8, true));
  const rest = Float64Array.from(reals(3 * nodes));
  const corners = Uint32Array.from({ length: 3 * triangles }, () => words.getUint32((at += 4) - 4, true));
  return { rest, triangles: corners, cornerPlaces: Float32Array.from(reals(2 * places)) };
}
