// The mesh of a cloth from its scene, node for node as Weft makes it (mesh/, scenes/cloth_source.cpp).
import type { TomlTable } from "smol-toml";

import { icosphere } from "./icosphere";
import { storedMesh } from "./stored_mesh";
import { quantity, table, text, vector } from "../scene";

export interface ClothMesh {
  /** [m], x y z of each node: where lengths are taken from. */
  rest: Float64Array;
  /** Three nodes each. */
  triangles: Uint32Array;
  /** Springs along the sides of the cells or triangles, two nodes each. */
  stretch: Uint32Array;
  /** [kg] of each node. */
  masses: Float64Array;
  /** Places in a picture, two for each node or for each corner of each triangle; none: empty. */
  nodePlaces: Float32Array;
  cornerPlaces: Float32Array;
}

type Surface = Pick<ClothMesh, "rest" | "triangles" | "cornerPlaces">;

/** Each side of the triangles once. */
export function sidesOf(triangles: Uint32Array): Uint32Array {
  const known = new Set<number>();
  const sides: number[] = [];
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; ++k) {
      const a = triangles[t + k]!;
      const b = triangles[t + ((k + 1) % 3)]!;
      const low = Math.min(a, b);
      const high = Math.max(a, b);
      const key = low * 0x4000000 + high;
      if (known.has(key)) continue;
      known.add(key);
      sides.push(low, high);
    }
  }
  return Uint32Array.from(sides);
}

/** [m^2] of a triangle. */
function area(x: Float64Array, a: number, b: number, c: number): number {
  const u = [0, 1, 2].map((k) => x[3 * b + k]! - x[3 * a + k]!) as [number, number, number];
  const v = [0, 1, 2].map((k) => x[3 * c + k]! - x[3 * a + k]!) as [number, number, number];
  return 0.5 * Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
}

function scaled(masses: Float64Array, total: number): Float64Array {
  const factor = total / masses.reduce((sum, mass) => sum + mass, 0);
  return masses.map((mass) => mass * factor);
}

function withCentre(surface: Surface, masses: Float64Array, share: number, total: number): [Float64Array, Float64Array] {
  const { rest, triangles } = surface;
  const centre = [0, 0, 0];
  let whole = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [triangles[t]!, triangles[t + 1]!, triangles[t + 2]!];
    const part = area(rest, a, b, c);
    whole += part;
    for (let k = 0; k < 3; ++k) centre[k]! += (part * (rest[3 * a + k]! + rest[3 * b + k]! + rest[3 * c + k]!)) / 3;
  }
  const positions = new Float64Array(rest.length + 3);
  positions.set(rest);
  positions.set(centre.map((sum) => sum / whole), rest.length);
  const all = new Float64Array(masses.length + 1);
  all.set(masses);
  all[masses.length] = share * total;
  return [positions, all];
}

/** Any triangles, with area or equal masses and possibly a node in the middle. */
export function surfaceBody(surface: Surface, cloth: TomlTable, source: TomlTable): ClothMesh {
  const { rest, triangles } = surface;
  const total = quantity(cloth["mass"], 1);
  const share = source["center_node"] === true ? quantity(source["center_mass_share"]) : 0;
  let masses = new Float64Array(rest.length / 3).fill(1);
  if (cloth["mass_lumping"] !== "uniform") {
    masses.fill(0);
    for (let t = 0; t < triangles.length; t += 3) {
      const [a, b, c] = [triangles[t]!, triangles[t + 1]!, triangles[t + 2]!];
      const third = area(rest, a, b, c) / 3;
      for (const node of [a, b, c]) masses[node]! += third;
    }
  }
  masses = scaled(masses, (1 - share) * total) as Float64Array<ArrayBuffer>;
  const base = { triangles, stretch: sidesOf(triangles), nodePlaces: new Float32Array(), cornerPlaces: surface.cornerPlaces };
  if (source["center_node"] !== true) return { ...base, rest, masses };
  const [positions, all] = withCentre(surface, masses, share, total);
  return { ...base, rest: positions, masses: all };
}

/** Turns and moves points in place. */
function place(points: Float64Array, cloth: TomlTable, position: string): void {
  const quaternion = table(cloth["orientation"])?.["quaternion"];
  const [w = 1, x = 0, y = 0, z = 0] = Array.isArray(quaternion) ? quaternion.map((q) => quantity(q)) : [];
  const at = vector(cloth[position]);
  for (let i = 0; i < points.length; i += 3) {
    const p = [points[i]!, points[i + 1]!, points[i + 2]!] as const;
    // p + 2 w (q x p) + 2 q x (q x p)
    const c = [y * p[2] - z * p[1], z * p[0] - x * p[2], x * p[1] - y * p[0]] as const;
    const d = [y * c[2] - z * c[1], z * c[0] - x * c[2], x * c[1] - y * c[0]] as const;
    for (let k = 0; k < 3; ++k) points[i + k] = p[k]! + 2 * (w * c[k]! + d[k]!) + at[k]!;
  }
}

function gridMesh(cloth: TomlTable, grid: TomlTable): ClothMesh {
  const [columns = 2, rows = 2] = (grid["nodes"] as number[]).map(Number);
  const [width = 1, height = 1] = (grid["size"] as string[]).map((size) => quantity(size));
  const centre = vector(cloth["center"]);
  const unit = (axis: number[], length: number): number[] => axis.map((c) => (c / Math.hypot(...axis)) * length);
  const u = unit(vector(cloth["u_axis"], [1, 0, 0]), width);
  const v = unit(vector(cloth["v_axis"], [0, 0, -1]), height);
  const count = columns * rows;
  const mesh: ClothMesh = {
    rest: new Float64Array(3 * count),
    triangles: new Uint32Array(6 * (columns - 1) * (rows - 1)),
    stretch: new Uint32Array(),
    masses: new Float64Array(count),
    nodePlaces: new Float32Array(2 * count),
    cornerPlaces: new Float32Array(),
  };
  const sides: number[] = [];
  const uniform = cloth["mass_lumping"] === "uniform";
  let t = 0;
  for (let j = 0; j < rows; ++j) {
    for (let i = 0; i < columns; ++i) {
      const a = j * columns + i;
      const [s, r] = [i / (columns - 1), j / (rows - 1)];
      for (let k = 0; k < 3; ++k) mesh.rest[3 * a + k] = centre[k]! + (s - 0.5) * u[k]! + (r - 0.5) * v[k]!;
      mesh.nodePlaces.set([s, r], 2 * a);
      const isSide = (at: number, end: number): number => (at === 0 || at === end - 1 ? 0.5 : 1);
      mesh.masses[a] = uniform ? 1 : isSide(i, columns) * isSide(j, rows);
      if (i + 1 < columns) sides.push(a, a + 1);
      if (j + 1 < rows) sides.push(a, a + columns);
      if (i + 1 >= columns || j + 1 >= rows) continue;
      const [b, c, d] = [a + 1, a + columns, a + columns + 1];
      mesh.triangles.set((i + j) % 2 === 0 ? [a, b, d, a, d, c] : [a, b, c, b, d, c], t);
      t += 6;
    }
  }
  mesh.stretch = Uint32Array.from(sides);
  mesh.masses = scaled(mesh.masses, quantity(cloth["mass"], 1));
  raise(mesh.rest, cloth, centre, u, v);
  return mesh;
}

/** A grid that is raised around its centre. */
function raise(rest: Float64Array, cloth: TomlTable, centre: number[], u: number[], v: number[]): void {
  const bulge = table(cloth["bulge"]);
  if (!bulge) return;
  const [height, radius] = [quantity(bulge["height"]), quantity(bulge["radius"], 1)];
  const cross = [u[1]! * v[2]! - u[2]! * v[1]!, u[2]! * v[0]! - u[0]! * v[2]!, u[0]! * v[1]! - u[1]! * v[0]!];
  for (let i = 0; i < rest.length; i += 3) {
    const share = Math.hypot(...[0, 1, 2].map((k) => rest[i + k]! - centre[k]!)) / radius;
    if (share >= 1) continue;
    for (let k = 0; k < 3; ++k) rest[i + k]! += (height * (1 - share * share) ** 2 * cross[k]!) / Math.hypot(...cross);
  }
}

function ropeMesh(cloth: TomlTable, rope: TomlTable): ClothMesh {
  const count = quantity(rope["nodes"], 2);
  const [start, end] = [vector(rope["start"]), vector(rope["end"])];
  const rest = new Float64Array(3 * count);
  const masses = new Float64Array(count).fill(1);
  const stretch = new Uint32Array(2 * (count - 1));
  for (let i = 0; i < count; ++i) {
    const part = i / (count - 1);
    for (let k = 0; k < 3; ++k) rest[3 * i + k] = (1 - part) * start[k]! + part * end[k]!;
    if (i + 1 < count) stretch.set([i, i + 1], 2 * i);
  }
  if (cloth["mass_lumping"] !== "uniform") masses[0] = masses[count - 1] = 0.5;
  return {
    rest,
    triangles: new Uint32Array(),
    stretch,
    masses: scaled(masses, quantity(cloth["mass"], 1)),
    nodePlaces: new Float32Array(),
    cornerPlaces: new Float32Array(),
  };
}

/** Of a character's skin, which its bones lead: no springs, and no mass that counts. */
export function asSkin(body: ClothMesh): ClothMesh {
  return { ...body, stretch: new Uint32Array(), masses: new Float64Array(body.masses.length) };
}

/** null: a source that this page does not know; parts of characters are made in character_mesh.ts. */
export function makeClothMesh(cloth: TomlTable): ClothMesh | null {
  const grid = table(cloth["grid"]);
  if (grid) return gridMesh(cloth, grid);
  const rope = table(cloth["rope"]);
  if (rope) return ropeMesh(cloth, rope);
  const sphere = table(cloth["icosphere"]);
  if (sphere) {
    const surface = icosphere(quantity(sphere["radius"], 1), quantity(sphere["frequency"], 1));
    place(surface.rest, cloth, "center");
    return surfaceBody(surface, cloth, sphere);
  }
  const mesh = table(cloth["mesh"]);
  if (!mesh) return null;
  const surface = storedMesh(text(mesh["data"]));
  place(surface.rest, cloth, "position");
  return surfaceBody(surface, cloth, mesh);
}
