// Geometries of the shapes of docs/colliders.md, in their own frames.
import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CapsuleGeometry,
  ConeGeometry,
  CylinderGeometry,
  Matrix4,
  Quaternion,
  SphereGeometry,
  Vector3,
} from "three";
import { ConvexGeometry } from "three/examples/jsm/geometries/ConvexGeometry.js";
import { mergeGeometries, toCreasedNormals } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import type { TomlTable, TomlValue } from "smol-toml";

import { quantity, table, tables, text, vector } from "../scene";

const CREASE = 0.5236; // [rad] faces that meet at less are drawn as one round surface

function numbers(value: TomlValue | undefined): number[] {
  return Array.isArray(value) ? value.flatMap((entry) => (Array.isArray(entry) ? numbers(entry) : [quantity(entry)])) : [];
}

function surface(points: number[], triangles: number[]): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
  geometry.setIndex(triangles);
  return toCreasedNormals(geometry, CREASE);
}

function hull(points: number[]): BufferGeometry {
  const corners: Vector3[] = [];
  for (let i = 0; i + 2 < points.length; i += 3) corners.push(new Vector3(points[i], points[i + 1], points[i + 2]));
  return toCreasedNormals(new ConvexGeometry(corners), CREASE);
}

function heightField(entry: TomlTable): BufferGeometry {
  const [width = 1, depth = 1] = numbers(entry["size"]);
  const rows = (entry["heights"] as TomlValue[]).map((row) => numbers(row));
  const columns = rows[0]?.length ?? 0;
  const points: number[] = [];
  const triangles: number[] = [];
  rows.forEach((row, j) => {
    row.forEach((height, i) => {
      points.push(width * (i / (columns - 1) - 0.5), height, depth * (j / (rows.length - 1) - 0.5));
      if (i + 1 === columns || j + 1 === rows.length) return;
      const a = j * columns + i;
      triangles.push(a, a + columns, a + columns + 1, a, a + columns + 1, a + 1);
    });
  });
  return surface(points, triangles);
}

function partOf(entry: TomlTable): BufferGeometry | null {
  const geometry = shapeGeometry(entry);
  const [w = 1, x = 0, y = 0, z = 0] = numbers(table(entry["orientation"])?.["quaternion"]);
  const pose = new Matrix4().compose(new Vector3(...vector(entry["position"])), new Quaternion(x, y, z, w), new Vector3(1, 1, 1));
  geometry?.applyMatrix4(pose);
  return geometry?.getIndex() ? geometry.toNonIndexed() : geometry;
}

/** null for a plane, which is the ground. Parts that differ in their attributes keep place and normal alone. */
export function shapeGeometry(entry: TomlTable): BufferGeometry | null {
  const radius = quantity(entry["radius"], 1);
  const height = quantity(entry["height"], 1);
  switch (text(entry["shape"])) {
    case "sphere":
      return new SphereGeometry(radius, 64, 48);
    case "box":
      return new BoxGeometry(...vector(entry["size"], [1, 1, 1]));
    case "capsule":
      return new CapsuleGeometry(radius, height, 16, 48);
    case "cylinder":
      return new CylinderGeometry(radius, radius, height, 64);
    case "cone":
      return new ConeGeometry(radius, height, 64);
    case "convex_hull":
      return hull(numbers(entry["points"]));
    case "mesh":
      return surface(numbers(entry["points"]), numbers(entry["triangles"]));
    case "height_field":
      return heightField(entry);
    case "compound": {
      const parts = tables(entry["part"]).map(partOf).filter((part) => part !== null);
      for (const part of parts) part.deleteAttribute("uv");
      return mergeGeometries(parts);
    }
    default:
      return null;
  }
}
