// Nodes and triangles of an icosphere, in the order of mesh/icosphere.cpp.
const GOLDEN = 1.6180339887498949;
// prettier-ignore
const CORNERS = [
  [-1, GOLDEN, 0], [1, GOLDEN, 0], [-1, -GOLDEN, 0], [1, -GOLDEN, 0], [0, -1, GOLDEN], [0, 1, GOLDEN],
  [0, -1, -GOLDEN], [0, 1, -GOLDEN], [GOLDEN, 0, -1], [GOLDEN, 0, 1], [-GOLDEN, 0, -1], [-GOLDEN, 0, 1],
] as const;
// prettier-ignore
const FACES = [
  [0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2], [10, 7, 6], [7, 1, 8],
  [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11], [6, 2, 10], [8, 6, 7], [9, 8, 1],
] as const;

export function icosphere(
  radius: number,
  frequency: number,
): { rest: Float64Array; triangles: Uint32Array; cornerPlaces: Float32Array } {
  const known = new Map<string, number>();
  const directions: number[][] = [];
  // Points on shared edges and corners meet.
  const node = (corners: readonly [number, number, number], i: number, j: number): number => {
    const weights = [frequency - i - j, i, j] as const;
    const parts = corners.map((corner, k) => [corner, weights[k]!] as const).filter(([, weight]) => weight > 0);
    const key = parts
      .map((part) => part.join("*"))
      .sort()
      .join("+");
    const found = known.get(key);
    if (found !== undefined) return found;
    const sum = [0, 1, 2].map((axis) => parts.reduce((total, [c, w]) => total + w * CORNERS[c]![axis]!, 0));
    known.set(key, directions.length);
    directions.push(sum.map((x) => x / Math.hypot(...sum)));
    return directions.length - 1;
  };
  const triangles: number[] = [];
  // Nodes are numbered as they are met: the last corner of a triangle first.
  const add = (face: readonly [number, number, number], corners: [number, number][]): void => {
    const [c, b, a] = [...corners].reverse().map(([i, j]) => node(face, i, j)) as [number, number, number];
    triangles.push(a, b, c);
  };
  for (const face of FACES) {
    for (let i = 0; i < frequency; ++i) {
      for (let j = 0; i + j < frequency; ++j) {
        add(face, [[i, j], [i + 1, j], [i, j + 1]]);
        if (i + j + 1 < frequency) add(face, [[i + 1, j], [i + 1, j + 1], [i, j + 1]]);
      }
    }
  }
  return {
    rest: Float64Array.from(directions.flatMap((direction) => direction.map((x) => radius * x))),
    triangles: Uint32Array.from(triangles),
    cornerPlaces: new Float32Array(), // painted by direction
  };
}
