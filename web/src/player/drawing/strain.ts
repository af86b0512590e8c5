// Strain of each node: the relative change of length, signed, of that of its springs which changed most.
import type { ClothMesh } from "../meshes/cloth_mesh";
import type { Topology } from "../files/recording";
import { sidesOf } from "../meshes/cloth_mesh";

/** Springs with their lengths at rest. */
export interface Springs {
  nodes: Uint32Array; // two each
  lengths: Float64Array; // [m]
}

function length(x: ArrayLike<number>, a: number, b: number): number {
  return Math.hypot(x[3 * a]! - x[3 * b]!, x[3 * a + 1]! - x[3 * b + 1]!, x[3 * a + 2]! - x[3 * b + 2]!);
}

/** Those of the whole cloth, or what is left of them once it has torn: the sides that are still there. */
export function springsOf(mesh: ClothMesh, topology: Topology | null): Springs {
  const first = mesh.rest.length / 3;
  const origin = (node: number): number => (node < first ? node : topology!.origins[node - first]!);
  let nodes = mesh.stretch;
  if (topology) {
    const key = (a: number, b: number): number => Math.min(a, b) * 0x4000000 + Math.max(a, b);
    const whole = new Set<number>();
    for (let e = 0; e < mesh.stretch.length; e += 2) whole.add(key(mesh.stretch[e]!, mesh.stretch[e + 1]!));
    const sides = sidesOf(topology.triangles);
    const kept: number[] = [];
    for (let e = 0; e < sides.length; e += 2) {
      const [a, b] = [sides[e]!, sides[e + 1]!];
      if (whole.has(key(origin(a), origin(b)))) kept.push(a, b);
    }
    nodes = Uint32Array.from(kept);
  }
  const lengths = new Float64Array(nodes.length / 2);
  for (let e = 0; e < lengths.length; ++e) lengths[e] = length(mesh.rest, origin(nodes[2 * e]!), origin(nodes[2 * e + 1]!));
  return { nodes, lengths };
}

/** [-], one value for each node. */
export function nodeStrain(springs: Springs, positions: ArrayLike<number>): Float64Array {
  const strain = new Float64Array(positions.length / 3);
  for (let e = 0; e < springs.lengths.length; ++e) {
    const a = springs.nodes[2 * e]!;
    const b = springs.nodes[2 * e + 1]!;
    const value = length(positions, a, b) / springs.lengths[e]! - 1;
    // A value that is not a number stays, instead of losing every comparison.
    if (!Number.isNaN(strain[a]!) && !(Math.abs(value) <= Math.abs(strain[a]!))) strain[a] = value;
    if (!Number.isNaN(strain[b]!) && !(Math.abs(value) <= Math.abs(strain[b]!))) strain[b] = value;
  }
  return strain;
}
