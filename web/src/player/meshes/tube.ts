// A rope as a tube around its nodes, which follow one another.
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Vector3 } from "three";

function makeAttributes(geometry: BufferGeometry, nodes: number, sides: number): void {
  const vertices = nodes * (sides + 1);
  for (const name of ["position", "normal"]) {
    geometry.setAttribute(name, new BufferAttribute(new Float32Array(3 * vertices), 3).setUsage(DynamicDrawUsage));
  }
  const index: number[] = [];
  for (let i = 0; i + 1 < nodes; ++i) {
    for (let k = 0; k < sides; ++k) {
      const a = i * (sides + 1) + k;
      index.push(a, a + 1, a + sides + 1, a + 1, a + sides + 2, a + sides + 1);
    }
  }
  geometry.setIndex(index);
}

/** Fills the geometry; lengths in [m]. */
export function tube(
  geometry: BufferGeometry,
  positions: ArrayLike<number>,
  origin: readonly number[],
  radius: number,
  sides: number,
): void {
  const nodes = positions.length / 3;
  if (geometry.getAttribute("position")?.count !== nodes * (sides + 1)) makeAttributes(geometry, nodes, sides);
  const place = geometry.getAttribute("position") as BufferAttribute;
  const normals = geometry.getAttribute("normal") as BufferAttribute;
  const at = (i: number): Vector3 =>
    new Vector3(positions[3 * i]! - origin[0]!, positions[3 * i + 1]! - origin[1]!, positions[3 * i + 2]! - origin[2]!);
  // Carried along without turning around the rope.
  const across = new Vector3(1, 0.3, 0.2);
  for (let i = 0; i < nodes; ++i) {
    const centre = at(i);
    const way = at(Math.min(i + 1, nodes - 1)).sub(at(Math.max(i - 1, 0))).normalize();
    across.addScaledVector(way, -across.dot(way)).normalize();
    const up = way.clone().cross(across);
    for (let k = 0; k <= sides; ++k) {
      const angle = (2 * Math.PI * k) / sides;
      const normal = across.clone().multiplyScalar(Math.cos(angle)).addScaledVector(up, Math.sin(angle));
      const vertex = i * (sides + 1) + k;
      normals.setXYZ(vertex, normal.x, normal.y, normal.z);
      place.setXYZ(vertex, centre.x + radius * normal.x, centre.y + radius * normal.y, centre.z + radius * normal.z);
    }
  }
  place.needsUpdate = true;
  normals.needsUpdate = true;
}
